// SPDX-License-Identifier: Apache-2.0
// The commands of MapperService, and how it goes on from a saved map.
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/map_file/saved_map.hpp"
#include "common/messages/json.hpp"
#include "services/mapper/core/map_files.hpp"
#include "services/mapper/mapper_service.hpp"

namespace rds::mapper {
namespace {

constexpr std::chrono::seconds kRestLimit{30};          // lockstep: everything that was sent must come
constexpr std::chrono::milliseconds kQuietLimit{1500};  // real time: what has not come by then was dropped

}  // namespace

service::CommandOutcome MapperService::execute(const std::string& verb, const std::string& argument) {
  if (verb == "finish") return finish(argument);
  if (verb == "save") return save(argument);
  if (verb == "load") return load(argument);
  if (verb == "reset") {
    mapper_.reset(mapper_.map_epoch());
    outputs_.begin_map();
    forget_keyframes();
    publish_all();
    return {true, fmt::format("map of {} nodes", mapper_.tree().size())};
  }
  if (verb == "pause" || verb == "resume") {
    paused_ = verb == "pause";
    return {true, paused_ ? "paused" : "resumed"};
  }
  return unknown_command(verb);
}

/// Nothing more comes: integrates the rest, then makes the map again from scratch with the final poses, so
/// that it depends on the data alone and not on when they arrived.
service::CommandOutcome MapperService::finish(const std::string& argument) {
  const auto json = nlohmann::json::parse(argument, nullptr, false);
  const auto count = [&json](const char* key) {
    const bool given = json.is_object() && json.contains(key);
    if (given && !json[key].is_number_unsigned())
      throw std::invalid_argument(fmt::format("finish: {}: expected a number", key));
    return given ? json[key].get<std::uint64_t>() : 0;
  };
  const std::uint64_t revision = count("poses_revision");
  const std::uint64_t keyframes = count("keyframes");
  wait_for_rest(revision, keyframes);
  while (!waiting_.empty()) integrate(waiting_.take_oldest());
  outputs_.publish_delta(mapper_.settle(poses_));
  publish_all();
  outputs_.flush();
  const bool complete =
      poses_revision_ >= revision && (!config_.lockstep || mapper_.keyframes() >= keyframes);
  const Eigen::Vector3d up = mapper_.up_in_map();
  return {complete, messages::to_text(nlohmann::json{{"keyframes", mapper_.keyframes()},
                                                     {"poses_revision", poses_revision_},
                                                     {"revision", mapper_.revision()},
                                                     {"up", {up.x(), up.y(), up.z()}},
                                                     {"labels", mapper_.labels().names()}})};
}

void MapperService::wait_for_rest(std::uint64_t poses_revision, std::uint64_t keyframes) {
  using Clock = std::chrono::steady_clock;
  auto deadline = Clock::now() + (config_.lockstep ? std::chrono::milliseconds(kRestLimit) : kQuietLimit);
  while (!stop_.stop_requested()) {
    beat();
    take_arrivals();
    integrate_ready();
    if (poses_revision_ >= poses_revision && mapper_.keyframes() >= keyframes) return;
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now());
    if (left.count() <= 0) return;
    mailbox_.wait_for(stop_, left, [this] { return something_arrived(); });
  }
}

/// From a saved map, or from OctoMap's tree in a file.
tl::expected<void, std::string> MapperService::start_from(const std::filesystem::path& saved_map) {
  const auto refuse = [&](const std::string& why) {
    return tl::unexpected(fmt::format("{}: cannot be mapped on: {}", saved_map.string(), why));
  };
  if (looks_like_tree(saved_map)) {
    auto tree = read_tree(saved_map);
    if (!tree) return tl::unexpected(tree.error());
    const auto started = mapper_.start_from(std::move(**tree));
    return started ? started : refuse(started.error());
  }
  const auto sections = map_file::read_saved_map(saved_map, {map_file::kMapper});
  if (!sections) return tl::unexpected(sections.error());
  const auto started = mapper_.start_from(sections->at(map_file::kMapper));
  return started ? started : refuse(started.error());
}

service::CommandOutcome MapperService::save(const std::string& folder) const {
  const std::filesystem::path place(folder);
  for (const WriteResult& result :
       {write_tree(place / "map.ot", mapper_.tree()),
        write_objects(place / "objects.json", mapper_.objects()), write_grid(place, mapper_.grid()),
        map_file::write_map_file(map_file::service_file(place, map_file::kMapper),
                                 {{map_file::kMapper, mapper_.to_bytes()}})})
    if (!result) return {false, result.error()};
  return {true, fmt::format("map of {} nodes written to {}", mapper_.tree().size(), folder)};
}

service::CommandOutcome MapperService::load(const std::string& saved_map) {
  if (const auto started = start_from(saved_map); !started) return {false, started.error()};
  outputs_.begin_map();
  forget_keyframes();
  publish_all();
  return {true, fmt::format("map of {} nodes", mapper_.tree().size())};
}

}  // namespace rds::mapper
