// SPDX-License-Identifier: Apache-2.0
// The commands of MapperService.
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/map_file/saved_map.hpp"
#include "common/messages/json.hpp"
#include "services/mapper/io/map_files.hpp"
#include "services/mapper/mapper_service.hpp"
#include "services/mapper/saved_start.hpp"

namespace rds::mapper {
namespace {

constexpr std::chrono::seconds kRestLimit{30};          // lockstep: everything that was sent must come
constexpr std::chrono::milliseconds kQuietLimit{1500};  // real time: what has not come by then was dropped

std::string size_of(const SemanticMapper& mapper) {
  return fmt::format("map of {} nodes", mapper.map().tree().size());
}

map_file::MapPart map_part(const SemanticMapper& mapper, const GridConfig& grid) {
  const Eigen::Vector3d up = mapper.up_in_map();
  const SemanticMap& map = mapper.map();
  return {map_file::kMapper,
          {{map_file::kMapper, to_bytes(map, up)}},
          files_for_others(map.tree(), map.objects(up), make_grid(map.tree(), up, grid))};
}

}  // namespace

bool MapperService::begin(const service::PendingCommand& command) {
  if (command.verb == "save") {
    map_commands_.save(
        command, [this] { return map_part(mapper_, config_.mapper.grid); }, size_of(mapper_));
    return true;
  }
  if (command.verb != "load") return false;
  using map_commands::MapCommands;
  map_commands_.load(
      command,
      [this](const map_file::Folder& map,
             const map_file::FileLimits& limits) -> tl::expected<MapCommands::Completion, std::string> {
        auto start = read_start(map, limits, config_.mapper);  // on a thread of its own
        if (!start) return tl::unexpected(start.error());
        return [this, start = std::move(*start)]() -> service::CommandOutcome {
          mapper_.start_from(start);
          begin_map();
          outputs_.publish_all(mapper_, queue_.size());
          return {true, size_of(mapper_)};
        };
      });
  return true;
}

service::CommandOutcome MapperService::execute(const std::string& verb, const std::string& argument) {
  if (verb == "finish") return finish(argument);
  if (verb == "reset") {
    mapper_.reset(mapper_.map().epoch);
    begin_map();
    outputs_.publish_all(mapper_, queue_.size());
    return {true, size_of(mapper_)};
  }
  if (verb == "pause" || verb == "resume") {
    is_paused_ = verb == "pause";
    return {true, is_paused_ ? "paused" : "resumed"};
  }
  return unknown_command(verb);
}

void MapperService::reconfigure(const MapperServiceConfig& config) {
  config_.mapper.grid = config.mapper.grid;
  queue_.wait_for_boxes(config.boxes_timeout_s);
  outputs_.reconfigure(config.mapper.grid, config.full_map_every);
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
  while (!queue_.empty()) integrate(queue_.take_oldest());
  integrate_placed(unplaced_.size());
  outputs_.publish_delta(mapper_.settle(poses_.poses()), mapper_);
  outputs_.publish_all(mapper_, queue_.size());
  outputs_.flush();
  const bool complete = poses_.revision() >= revision &&
                        (!config_.lockstep || mapper_.archive().size() + unplaced_.dropped() >= keyframes);
  const Eigen::Vector3d up = mapper_.up_in_map();
  return {complete, messages::to_text(nlohmann::json{{"keyframes", mapper_.archive().size()},
                                                     {"poses_revision", poses_.revision()},
                                                     {"revision", mapper_.map().revision},
                                                     {"up", {up.x(), up.y(), up.z()}},
                                                     {"labels", mapper_.map().labels.names()}})};
}

/// Ends early where nothing has come for a while.
void MapperService::wait_for_rest(std::uint64_t poses_revision, std::uint64_t keyframes) {
  const auto limit = config_.lockstep ? std::chrono::milliseconds(kRestLimit) : kQuietLimit;
  bool is_quiet = false;
  while (!stop_.stop_requested() && !is_quiet) {
    beat();
    take_messages();
    integrate_ready();
    integrate_placed(unplaced_.size());
    if (poses_.revision() >= poses_revision && mapper_.archive().size() >= keyframes) return;
    is_quiet = !mailbox_.wait_for(stop_, limit, [this] { return !inboxes_.locked_empty(); });
  }
}

}  // namespace rds::mapper
