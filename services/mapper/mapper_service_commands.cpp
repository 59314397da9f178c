// SPDX-License-Identifier: Apache-2.0
// The commands of MapperService, and how it goes on from a saved map.
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/map_file/saved_map.hpp"
#include "common/messages/json.hpp"
#include "services/mapper/io/map_files.hpp"
#include "services/mapper/io/octomap_file.hpp"
#include "services/mapper/mapper_service.hpp"

namespace rds::mapper {
namespace {

constexpr std::chrono::seconds kRestLimit{30};          // lockstep: everything that was sent must come
constexpr std::chrono::milliseconds kQuietLimit{1500};  // real time: what has not come by then was dropped

std::string not_mapped_on(const std::filesystem::path& from, const std::string& why) {
  return fmt::format("{}: cannot be mapped on: {}", from.string(), why);
}

}  // namespace

service::CommandOutcome MapperService::execute(const std::string& verb, const std::string& argument) {
  if (verb == "finish") return finish(argument);
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
      poses_revision_ >= revision && (!config_.lockstep || mapper_.archive().size() >= keyframes);
  const Eigen::Vector3d up = mapper_.up_in_map();
  return {complete, messages::to_text(nlohmann::json{{"keyframes", mapper_.archive().size()},
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
    take_messages();
    integrate_ready();
    if (poses_revision_ >= poses_revision && mapper_.archive().size() >= keyframes) return;
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now());
    if (left.count() <= 0) return;
    mailbox_.wait_for(stop_, left, [this] { return has_messages(); });
  }
}

/// From the setting map_file: a saved map, or OctoMap's tree. @throws std::runtime_error with one sentence.
void MapperService::read_start() {
  const std::filesystem::path from = config_.map_file;
  const auto limits = map_commands::limits_of(config_.maps);
  tl::expected<void, std::string> started;
  if (looks_like_tree(from)) {
    auto tree = read_tree(from, limits);
    if (!tree) throw std::runtime_error(tree.error());
    started = mapper_.start_from(std::move(**tree));
  } else {
    const auto sections = map_file::read_saved_map(from, {map_file::kMapper}, limits);
    if (!sections) throw std::runtime_error(sections.error());
    started = mapper_.start_from(sections->at(map_file::kMapper));
  }
  if (!started) throw std::runtime_error(not_mapped_on(from, started.error()));
}

bool MapperService::begin(const service::PendingCommand& command) {
  if (command.verb == "load") {
    load(command);
  } else if (command.verb == "save") {
    map_commands_.save(
        command, [this] { return map_part(); }, fmt::format("map of {} nodes", mapper_.tree().size()));
  } else {
    return false;
  }
  return true;
}

map_file::MapPart MapperService::map_part() const {
  return {map_file::kMapper,
          {{map_file::kMapper, mapper_.to_bytes()}},
          files_for_others(mapper_.tree(), mapper_.objects(), mapper_.grid())};
}

/// Of a map that only OctoMap knows, its map.ot.
void MapperService::load(const service::PendingCommand& command) {
  using map_commands::MapCommands;
  map_commands_.load(command, [this](const map_file::Folder& map, const map_file::FileLimits& limits)
                                  -> tl::expected<MapCommands::Completion, std::string> {
    const auto from = map.path();
    if (!map.has_file(map_file::kMapFile) && map.has_file(kTreeFile)) {
      const auto bytes = map.read(kTreeFile, limits);
      auto tree = bytes ? tree_from_octomap_file(*bytes) : tl::unexpected(bytes.error());
      if (!tree) return tl::unexpected(tree.error());
      const auto read = std::make_shared<std::unique_ptr<octomap::ColorOcTree>>(std::move(*tree));
      return [this, from, read] { return finish_load(mapper_.start_from(std::move(**read)), from); };
    }
    auto sections = map_file::read_saved_map(map, {map_file::kMapper}, limits);
    if (!sections) return tl::unexpected(sections.error());
    const auto read = std::make_shared<map_file::Bytes>(std::move(sections->at(map_file::kMapper)));
    return [this, from, read] { return finish_load(mapper_.start_from(*read), from); };
  });
}

/// The new map is published; of one that does not fit nothing has changed.
service::CommandOutcome MapperService::finish_load(const tl::expected<void, std::string>& started,
                                                 const std::filesystem::path& from) {
  if (!started) return {false, not_mapped_on(from, started.error())};
  outputs_.begin_map();
  forget_keyframes();
  publish_all();
  return {true, fmt::format("map of {} nodes", mapper_.tree().size())};
}

}  // namespace rds::mapper
