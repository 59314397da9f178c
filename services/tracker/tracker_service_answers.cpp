// SPDX-License-Identifier: Apache-2.0
// What others have answered to TrackerService's keyframes, and what they are asked for.
#include <algorithm>
#include <cmath>
#include <utility>

#include <spdlog/spdlog.h>

#include "common/messages/conversions.hpp"
#include "common/messages/detection_conversions.hpp"
#include "common/messages/keyframe_conversions.hpp"
#include "common/messages/keyframe_pose_table.hpp"
#include "common/topics/endpoints.hpp"
#include "services/tracker/tracker_service.hpp"

namespace rds::tracker {
namespace {

/// Only the map takes keyframes without, and these have their features.
bool has_depth(const KeyframeData& keyframe) {
  return !keyframe.in_map || std::ranges::any_of(keyframe.features, [](const KeyframeFeature& f) {
    return f.feature.depth_m > 0;
  });
}

}  // namespace

void TrackerService::apply_answers() {
  for (const LocalMappingResult& result : answers_.take_mappings(frame_index_))
    guarded("local mapping", [&] { apply(result); });
  for (const LocalMappingResult& result : answers_.take_adjustments(frame_index_))
    guarded("adjustment", [&] { apply_adjustment(result); });
  for (const PosesMessage& poses : answers_.take_poses(frame_index_))
    guarded(topics::kKeyframePoses.name, [&] { apply(poses); });
  for (const BoxesMessage& boxes : answers_.take_boxes(frame_index_))
    guarded(topics::kBoxes.name, [&] { apply(boxes); });
}

void TrackerService::apply(const LocalMappingResult& result) {
  tracker_.apply(result);
  const SelfCalibration& camera = tracker_.calibration();
  context_.diagnostics.counter("readout us") =
      static_cast<std::uint64_t>(std::max(0.0, camera.readout_s()) * 1e6);
  context_.diagnostics.counter("focal length permille") =
      static_cast<std::uint64_t>(std::lround(camera.focal_scale() * 1e3));
  publish_poses();
}

void TrackerService::apply(const PosesMessage& poses) {
  const LoopState& known = epoch_.loops();
  const bool same_closer = poses->instance() == known.instance;
  if (poses->revision() <= (same_closer ? known.revision : 0)) return;  // nothing new was closed
  const auto correction = messages::to_keyframe_poses(*poses);
  if (correction && correction->empty()) return;  // its poses came before
  if (!correction)
    return context_.diagnostics.reject(topics::kKeyframePoses.name, service::Rejection::kInvalid,
                                       correction.error());
  if (refused_loop_ == std::pair(poses->instance(), poses->revision())) return;
  const geometry::Pose before = tracker_.last_map_from_camera();
  if (!tracker_.correct(*correction, messages::to_loops(*poses))) {
    refused_loop_ = {poses->instance(), poses->revision()};
    ++context_.diagnostics.counter("loops refused");
    return spdlog::warn("loop {} is not confirmed by the map's points", poses->loops_closed());
  }
  move_map(before);
  epoch_.set_loops({poses->instance(), poses->revision(), poses->loops_closed()});
  spdlog::info("loop {} closed, keyframe poses corrected", poses->loops_closed());
  publish_poses();
}

void TrackerService::apply_adjustment(const LocalMappingResult& result) {
  const geometry::Pose before = tracker_.last_map_from_camera();
  if (!tracker_.apply_adjustment(result)) return;
  move_map(before);
  spdlog::info("{} keyframes and {} points adjusted", result.keyframes.size(), result.points.size());
  publish_poses();
}

/// What is kept in the map's frame moves with the camera. @param last_before  its last pose before it moved.
void TrackerService::move_map(const geometry::Pose& last_before) {
  const geometry::Pose corrected_from_map = tracker_.last_map_from_camera() * last_before.inverse();
  outputs_.odometry().move_map(corrected_from_map);
  objects_.move_map(corrected_from_map);
}

void TrackerService::apply(const BoxesMessage& boxes) {
  const std::int64_t stamp = messages::to_nanoseconds(boxes->header().stamp());
  const auto detections = messages::to_detections(*boxes);
  if (!detections)
    return context_.diagnostics.reject(topics::kBoxes.name, service::Rejection::kInvalid, detections.error());
  std::vector<prediction::ObjectObservation> observations;
  for (const auto& d : *detections) observations.push_back({d.box, d.label, d.score});
  const auto keyframe = answers_.take_snapshot(stamp);
  if (!keyframe) return objects_.observe(stamp, observations, std::nullopt);
  const auto& [id, camera_from_map, camera, place, has_depth] = *keyframe;
  if (place == place_ && (has_depth || !observations.empty()))
    objects_.observe(stamp, observations, prediction::KeyframeView{camera_from_map.inverse(), camera});
  tracker_.retract_movable(id, objects_.regions_of(observations, camera_from_map, camera));
}

void TrackerService::ask_for_answers(const KeyframeData& keyframe, const geometry::CameraModel& camera) {
  if (config_.dynamics)
    answers_.ask_for_boxes(
        keyframe.stamp_ns,
        {keyframe.id, keyframe.map_from_camera.inverse(), camera, place_, has_depth(keyframe)}, frame_index_);
  const bool corrections_wanted = keyframe.in_map && tracker_.submap() == Submaps::kMap &&
                                  config_.poses_file.empty() &&
                                  (config_.loop_closer || !config_.lockstep.enabled);
  if (corrections_wanted) answers_.ask_for_poses(keyframe.id, frame_index_);
}

void TrackerService::start_mapping() {
  if (auto job = tracker_.take_adjustment_job()) answers_.ask_for_adjustment(std::move(*job), frame_index_);
  if (answers_.is_mapping()) return;
  auto job = tracker_.take_mapping_job();
  if (job) answers_.ask_for_mapping(std::move(*job), frame_index_);
}

}  // namespace rds::tracker
