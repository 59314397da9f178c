// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/map_epoch.hpp"

#include <stdexcept>

#include <spdlog/spdlog.h>

#include "common/map_commands/map_commands.hpp"
#include "common/map_file/geometry_bytes.hpp"
#include "common/map_file/saved_map.hpp"
#include "common/service/checkpoints.hpp"
#include "common/service/random_id.hpp"
#include "services/tracker/saved_start.hpp"

namespace rds::tracker {
namespace {

/// Where nothing enters the map, or poses are given, there is none to find oneself in.
bool keeps_checkpoint(const TrackerServiceConfig& config) {
  return !config.tracker.localize_only && config.poses_file.empty();
}

}  // namespace

MapEpoch::MapEpoch(service::ServiceContext& context, const TrackerServiceConfig& config, Tracker& tracker)
    : tracker_(tracker),
      extraction_(config.tracker.extraction),
      is_read_only_(config.tracker.localize_only),
      epoch_{service::random_id(), 0, {}},
      checkpoints_(
          keeps_checkpoint(config) ? service::open_checkpoints(context, config.maps, "tracker") : nullptr,
          config.maps.checkpoint_s),
      resume_(config.resume_s) {
  if (!config.map_file.empty()) {
    auto saved = read_saved_start(config.map_file, map_commands::limits_of(config.maps), config.tracker);
    if (!saved) throw std::runtime_error(saved.error());
    start_ = std::move(saved->map);
    epoch_.start = saved->checksum;
    start_map();
  }
  resume();
  spdlog::info("map epoch {:016x}", id());
}

/// Goes on in the map, and the epoch, of the process before this one, if it has left a checkpoint.
void MapEpoch::resume() {
  const auto left = checkpoints_.restore(epoch_.start, tracker_);
  if (!left) spdlog::warn("the map of the checkpoint is not used: {}", left.error());
  if (!left || !*left) return checkpoints_.clear();
  epoch_ = **left;
  resume_.begin();
  spdlog::info("goes on in a map of {}", description());
}

void MapEpoch::start_map() {
  if (!start_) return;
  tracker_.start_from(SavedMap(*start_));
  spdlog::info("goes on in a map of {}", description());
}

void MapEpoch::renew() {
  epoch_ = {service::random_id(), epoch_.start, {}};
  checkpoints_.clear();
  resume_.end();
  tracker_.reset();
  start_map();
  spdlog::info("begins again, map epoch {:016x}", id());
}

void MapEpoch::renew_in(SavedMap start) {
  start_ = std::move(start);
  renew();
}

bool MapEpoch::is_of_another_camera(const image::RgbdFrame& frame) const {
  const bool is_other =
      resume_.is_looking() && frame.camera.is_valid() && frame.camera.fx != tracker_.calibration().given_fx();
  if (is_other) spdlog::warn("the map of the checkpoint was made with another camera");
  return is_other;
}

bool MapEpoch::is_over(const image::RgbdFrame& frame, const FrameResult& result) {
  const bool is_usable = result.features >= kMinFeaturesToStart + result.dynamic_features;
  if (!resume_.take(frame.stamp_ns, has_pose(result.state), is_usable))
    return tracker_.has_lost_young_map(frame.stamp_ns);
  spdlog::warn("not found in the map of the checkpoint within {} s of usable pictures", resume_.patience_s());
  return true;
}

void MapEpoch::set_loops(const LoopState& loops) {
  epoch_.loops = loops;
  checkpoints_.schedule().hurry();
}

void MapEpoch::save_if_due() {
  if (checkpoints_.is_due()) save();
}

std::string MapEpoch::description() const {
  return fmt::format("{} keyframes and {} points", tracker_.map().keyframes().size(),
                     tracker_.map().points().size());
}

map_file::MapPart MapEpoch::part() const {
  const bool is_as_it_began = is_read_only_ && start_;
  const SlamMap& map = is_as_it_began ? start_->map : tracker_.map();
  const KnownCamera camera = is_as_it_began ? start_->camera : tracker_.calibration().known_camera();
  return {map_file::kTracker,
          {{map_file::kTracker, to_bytes(map, camera, extraction_)},
           {map_file::kKeyframePoses, map_file::to_bytes(keyframe_poses(map))}},
          {}};
}

}  // namespace rds::tracker
