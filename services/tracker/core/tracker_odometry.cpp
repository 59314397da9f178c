// SPDX-License-Identifier: Apache-2.0
// The part of Tracker that uses the robot's odometry and gyroscope.
#include "services/tracker/core/tracker.hpp"

namespace rds::tracker {
namespace {

// Of cameras of 10 Hz and more: what they accelerate from frame to frame is no more than odometry errs by.
constexpr double kShortGapS = 0.15;

constexpr double kLongestTurnS = 2;    // that a gyroscope is asked for: places do not stay longer
constexpr double kSameTurnRad = 0.01;  // 5 px: where constant velocity is as near, it is left alone

}  // namespace

/// How the camera has turned since the last pose, if a gyroscope that is trusted says so.
void Tracker::expect_by_gyroscope(std::int64_t stamp_ns, TrackingContext& context) {
  const std::optional<LastFrame>& last = localizer_.features().last();
  if (!last || context.motion.gap_s() > kLongestTurnS) return gyroscope_.begin_window();
  const auto turn = gyroscope_.expect(last->frame.stamp_ns, stamp_ns);
  if (!turn) return;
  const Eigen::Quaterniond steady(context.motion.last_map_from_camera().linear().transpose() *
                                  context.motion.camera_from_map().linear().transpose());
  if (steady.angularDistance(*turn) > kSameTurnRad) context.motion.expect_turn(*turn);
}

/// Where odometry, if it is trusted, expects the camera after a gap. A lost one is expected where it has been
/// carried on to.
void Tracker::expect_by_odometry(std::int64_t stamp_ns, TrackingContext& context) {
  odometry_.go_to(stamp_ns);
  const auto motion = odometry_.since_begin();
  if (!motion) return;
  context.carried = CarriedPose{sure_map_from_camera() * motion->begin_from_camera, motion->covariance};
  if (state_ == State::kLost || context.motion.gap_s() > kShortGapS)
    context.motion.expect(context.carried->map_from_camera.inverse());
}

/// Vision has lost the camera. The tracker itself stays lost: nothing of the frame supports a pose, or gets
/// into the map.
void Tracker::carry_on(const CarriedPose& carried, TrackedFrame& frame, FrameResult& result) {
  frame.camera_from_map = carried.map_from_camera.inverse();
  frame.information.setZero();
  frame.clear_matches();
  result.state = State::kWeak;
  result.carried_covariance = carried.covariance;
}

/// The frame has a pose. Of those in doubt nothing is learned; after a jump a window begins.
void Tracker::compare_with_odometry(const Pose& map_from_camera) {
  if (state_ == State::kWeak) return;
  bool begins = state_ == State::kRelocalised;
  if (begins)
    odometry_.begin_window();
  else
    begins = odometry_.observe(sure_map_from_camera().inverse() * map_from_camera);
  if (!begins) return;
  const KeyframeId reference = localizer_.features().reference();
  sure_ = {reference, mapper_.map().pose_of(reference).inverse() * map_from_camera};
}

bool Tracker::seek(const SoughtPlace& place) {
  if (state_ == State::kLost) localizer_.seek(place);
  return state_ == State::kLost;
}

Pose Tracker::sure_map_from_camera() const {
  return sure_.reference == kNoId ? Pose::Identity()
                                  : mapper_.map().pose_of(sure_.reference) * sure_.reference_from_camera;
}

}  // namespace rds::tracker
