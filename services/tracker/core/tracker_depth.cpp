// SPDX-License-Identifier: Apache-2.0
// The part of Tracker that depth alone tells the pose for a moment, where pictures show too little: blurred
// by a fast turn, or with people in front of nearly everything.
#include "services/tracker/core/relocalization/relocalization.hpp"
#include "services/tracker/core/tracker.hpp"

namespace rds::tracker {
namespace {

constexpr double kApartM = 0.1;  // from where depth has the camera, and …
constexpr double kApartRad = 0.1;

}  // namespace

/// nullopt where that was for too long, or depth does not tell.
std::optional<Pose> Tracker::pose_by_depth(std::int64_t time_ns) const {
  if (since_last_s(time_ns) > config_.quality.by_depth_s) return std::nullopt;
  return cut_.pose_by_depth(expected_at(time_ns));
}

/// Looks for the points of the map around there. @return true if that gave the pose.
bool Tracker::find_around(const Pose& by_depth, TrackedFrame& frame) {
  TrackedFrame found = frame;
  found.camera_from_map = by_depth;
  found.clear_matches();
  const KnownView view = nearest_view(found);
  const Keyframe* keyframe = map_.keyframe(view.keyframe);
  if (keyframe == nullptr) return false;
  const ObservationModel model(frame.features->camera(), config_.depth);
  const RelocalizationTools tools{model, pyramid_, config_.matching, config_.pose, config_.relocalization};
  localize_around(map_, *keyframe, tools, found);
  if (found.static_matches() < config_.quality.min_inliers) return false;
  const Twist apart = se3_log(found.camera_from_map * by_depth.inverse());
  if (apart.head<3>().norm() > kApartM || apart.tail<3>().norm() > kApartRad) return false;
  frame = std::move(found);
  refine_with_local_map(frame, 1);
  return frame.static_matches() >= config_.quality.min_inliers;
}

/// Weakly tracked: nothing is made of such a frame, and later ones are still matched with the one before.
State Tracker::hold(const Pose& by_depth, TrackedFrame& frame) {
  frame.camera_from_map = by_depth;
  frame.clear_matches();
  frame.held_by_depth = true;
  return State::kWeak;
}

}  // namespace rds::tracker
