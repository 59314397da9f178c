// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/mapping/local_mapper.hpp"

#include <algorithm>
#include <utility>

#include "services/tracker/core/mapping/map_building.hpp"
#include "services/tracker/core/mapping/mapping_exchange.hpp"

namespace rds::tracker {
namespace {

constexpr std::size_t kAwaitingBoxes = 30;  // keyframes whose boxes may still come
constexpr std::size_t kOutside = 1000;      // keyframes that are remembered where the map does not grow

}  // namespace

KeyframeData LocalMapper::insert(TrackedFrame& frame, std::shared_ptr<const ImagePyramid> images,
                                 const PictureCells& cells) {
  const PointId first_new = map_.next_point_id();
  Keyframe& keyframe = insert_keyframe(map_, frame, settings_.depth, settings_.map);
  frame.points = keyframe.points;
  keyframe.images = std::move(images);
  KeyframeData data = keyframe_data(map_, keyframe);
  for (PointId id = first_new; id < map_.next_point_id(); ++id) recent_points_.push_back(id);
  cull_recent_points(map_, keyframe.id, settings_.map, recent_points_);
  job_centre_ = keyframe.id;
  depths_.push_back({keyframe.id, cells});
  if (depths_.size() > kAwaitingBoxes) depths_.pop_front();
  return data;
}

KeyframePose LocalMapper::insert_pose_only(const TrackedFrame& frame, KeyframeId anchor) {
  const Pose map_from_camera = frame.camera_from_map.inverse();
  if (!grows_) {
    outside_.push_back({map_.next_keyframe_id() + outside_count_++, frame.stamp_ns, map_from_camera});
    if (outside_.size() > kOutside && settings_.map.pose_only_s > 0) outside_.pop_front();
    return outside_.back();
  }
  if (job_centre_ == kNoId) job_centre_ = anchor;  // nothing new: what is there gets better
  return {map_.add_passing(frame.stamp_ns, map_from_camera, anchor), frame.stamp_ns, map_from_camera};
}

std::vector<KeyframePose> LocalMapper::keyframe_poses() const {
  if (!grows_) return {outside_.begin(), outside_.end()};
  return map_.keyframe_poses(map_.first_free_keyframe());
}

const PictureCells* LocalMapper::cells_of(KeyframeId keyframe) const {
  const auto depth = std::ranges::find(depths_, keyframe, &KeyframeDepth::keyframe);
  return depth == depths_.end() ? nullptr : &depth->cells;
}

void LocalMapper::retract(KeyframeId keyframe, const MovableMask& movable) {
  const PointId first_new = map_.next_point_id();
  retract_movable(map_, keyframe, movable, settings_.depth, settings_.map);
  for (PointId id = first_new; id < map_.next_point_id(); ++id) recent_points_.push_back(id);
}

std::optional<LocalMappingJob> LocalMapper::take_job(const SelfCalibration& calibration) {
  const KeyframeId centre = std::exchange(job_centre_, kNoId);
  if (map_.keyframe(centre) == nullptr) return std::nullopt;  // none is due, or it was culled
  LocalMappingJob job = make_mapping_job(map_, centre, config_);
  job.revision = revision_;
  job.readout_s = calibration.readout_s();
  job.focal_scale = calibration.focal_scale();
  job.given_fx = calibration.given_fx();
  job.pyramid = settings_.pyramid;
  job.depth = settings_.depth;
  job.robust = settings_.optimization;
  job.fusion_max_distance = settings_.matching.max_distance_strict;
  return job;
}

std::optional<std::vector<KeyframeId>> LocalMapper::apply(const LocalMappingResult& result) {
  if (result.revision != revision_) return std::nullopt;
  apply_mapping_result(map_, result);
  return cull_redundant_keyframes(map_, result.keyframe, settings_.depth, settings_.map);
}

bool LocalMapper::is_mostly_static(KeyframeId id) const {
  const Keyframe* keyframe = map_.keyframe(id);
  return keyframe != nullptr &&
         2 * std::ranges::count(keyframe->movable, true) <= std::ssize(keyframe->movable);
}

void LocalMapper::correct(std::span<const KeyframePose> corrected) {
  apply_correction(map_, corrected);
  ++revision_;
}

void LocalMapper::start_from(SlamMap&& map, bool rows_are_known) {
  map_ = std::move(map);
  if (rows_are_known) checkpoint_.has_told(map_);
}

}  // namespace rds::tracker
