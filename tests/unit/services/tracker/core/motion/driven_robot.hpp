// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <random>

#include "services/tracker/core/motion/odometry_prior.hpp"

namespace rds::tracker::test {

/// A robot that drives in a circle of 1 m, its camera mounted off its middle, and what its wheels tell of
/// that.
class DrivenRobot {
 public:
  static constexpr double kStepS = 1.0 / 30;
  static constexpr double kSpeed = 0.4;  // m/s

  /// @param told  the step (v, ω) that the wheels tell of a true one.
  explicit DrivenRobot(std::function<Twist(const Twist&, int frame)> told) : told_(std::move(told)) {}

  [[nodiscard]] static std::int64_t stamp_ns(int frame) { return std::int64_t{frame} * 33'333'333; }
  /// From the first frame's camera, exactly.
  [[nodiscard]] geometry::Pose truth(int frame) const {
    return (body(0) * body_from_camera()).inverse() * body(frame) * body_from_camera();
  }
  RobotOdometry odometry() {
    return [this](std::int64_t stamp_ns) -> std::optional<OdometryPose> {
      const int frame = static_cast<int>((stamp_ns + 1'000'000) / 33'333'333);
      while (static_cast<int>(poses_.size()) <= frame) {
        const int next = static_cast<int>(poses_.size());
        const Twist step = se3_log(body(next - 1).inverse() * body(next));
        poses_.push_back(poses_.back() * se3_exp(told_(step, next)));
      }
      return OdometryPose{poses_[static_cast<std::size_t>(frame)], body_from_camera(), 0};
    };
  }
  /// 20 cm ahead, 50 cm up, looking ahead (REP 103).
  static geometry::Pose body_from_camera() {
    return geometry::make_pose({0.2, 0, 0.5}, Eigen::Quaterniond(-0.5, 0.5, -0.5, 0.5));
  }

 private:
  static geometry::Pose body(int frame) {
    const double angle = kSpeed * kStepS * frame;
    return geometry::make_pose({std::sin(angle), 1 - std::cos(angle), 0},
                               Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ())));
  }

  std::function<Twist(const Twist&, int)> told_;
  std::vector<geometry::Pose> poses_{geometry::Pose::Identity()};
};

}  // namespace rds::tracker::test
