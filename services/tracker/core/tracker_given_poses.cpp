// SPDX-License-Identifier: Apache-2.0
// The part of Tracker that follows given poses instead of estimating them.
#include "services/tracker/core/tracker.hpp"

namespace rds::tracker {

void Tracker::follow(TrackedFrame& frame, FrameResult& result) {
  const auto map_from_camera = given_poses_(frame.stamp_ns);
  if (!map_from_camera) {
    if (state_ != State::kNotInitialized) state_ = State::kLost;
    return;
  }
  frame.camera_from_map = map_from_camera->inverse();
  frame.pose_is_given = true;
  state_ = State::kTracking;
  if (reference_ == kNoId)
    make_keyframe(frame, result);
  else
    associate(frame);
}

/// Finds what a frame at a given pose sees of the map.
void Tracker::associate(TrackedFrame& frame) {
  const ObservationModel model(frame.features->camera(), config_.depth);
  const Keyframe* reference = map_.keyframe(reference_);
  if (last_)
    match_last_frame(map_, last_->frame, model, pyramid_, config_.matching, config_.matching.motion_window_px,
                     frame);
  else if (reference != nullptr)
    match_keyframe(map_, *reference, config_.matching, frame);
  optimize_frame(map_, model, pyramid_, config_.pose, frame);
  refine_with_local_map(frame, config_.matching.map_window_factor);
}

}  // namespace rds::tracker
