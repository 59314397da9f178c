// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/motion/motion_model.hpp"

#include <algorithm>
#include <numbers>

namespace rds::tracker {
namespace {

constexpr double kNsPerSecond = 1e9;
constexpr double kMaxPredictedGap = 0.5;               // s; beyond, constant velocity is a guess
constexpr double kMaxSpeed = 5;                        // m/s and …
constexpr double kMaxTurnRate = 2 * std::numbers::pi;  // rad/s, of a camera that is carried or driven
constexpr double kWalkingSpeed = 2;                    // m/s, of one that is lost
constexpr double kNear = 1.5;                          // m, of a keyframe that sees the same
constexpr double kPoseNoise = 0.01;                    // m and rad
constexpr double kMaxAcceleration = 15;                // m/s² and …
constexpr double kMaxTurnAcceleration = 40;            // rad/s², of a camera in a hand

}  // namespace

MotionPrediction::MotionPrediction(const geometry::Pose& last_map_from_camera,
                                   const std::optional<Twist>& velocity, double gap_s)
    : last_map_from_camera_(last_map_from_camera),
      velocity_(velocity),
      gap_s_(gap_s),
      camera_from_map_(last_map_from_camera.inverse()) {
  if (velocity_ && gap_s_ > 0 && gap_s_ <= kMaxPredictedGap)
    camera_from_map_ = se3_exp(gap_s_ * *velocity_) * camera_from_map_;
}

void MotionPrediction::expect_turn(const Eigen::Quaterniond& turn) {
  const Eigen::Vector3d place = camera_from_map_.inverse().translation();
  camera_from_map_ =
      geometry::make_pose(place, Eigen::Quaterniond(last_map_from_camera_.linear()) * turn).inverse();
}

Twist MotionPrediction::velocity() const {
  return velocity_ && gap_s_ <= kMaxPredictedGap ? *velocity_ : Twist::Zero();
}

std::optional<Twist> MotionPrediction::velocity_to(const geometry::Pose& camera_from_map) const {
  if (gap_s_ <= 0 || gap_s_ > kMaxPredictedGap) return std::nullopt;
  return Twist(se3_log(camera_from_map * last_map_from_camera_) / gap_s_);
}

bool MotionPrediction::is_jump(const geometry::Pose& camera_from_map) const {
  const auto motion = velocity_to(camera_from_map);
  return motion && (motion->head<3>().norm() > kMaxSpeed || motion->tail<3>().norm() > kMaxTurnRate);
}

bool MotionPrediction::can_be_near(const geometry::Pose& map_from_other) const {
  return (map_from_other.translation() - last_map_from_camera_.translation()).norm() <=
         kNear + kWalkingSpeed * gap_s_;
}

double MotionPrediction::innovation(const geometry::Pose& camera_from_map) const {
  if (gap_s_ <= 0 || gap_s_ > kMaxPredictedGap) return 0;
  const Twist error = se3_log(camera_from_map * camera_from_map_.inverse());
  return std::max(error.head<3>().norm() / (kPoseNoise + kMaxAcceleration * gap_s_ * gap_s_ / 2),
                  error.tail<3>().norm() / (kPoseNoise + kMaxTurnAcceleration * gap_s_ * gap_s_ / 2));
}

MotionPrediction MotionModel::predict(const geometry::Pose& last_map_from_camera,
                                      std::int64_t time_ns) const {
  if (!last_time_ns_) return {};
  return {last_map_from_camera, velocity_, static_cast<double>(time_ns - *last_time_ns_) / kNsPerSecond};
}

}  // namespace rds::tracker
