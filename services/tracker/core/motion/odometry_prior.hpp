// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <utility>

#include "services/tracker/core/motion/odometry_path.hpp"

namespace rds::tracker {

/// Where a robot's odometry has its body, and where the camera is on it.
struct OdometryPose {
  geometry::Pose odom_from_body = geometry::Pose::Identity();
  geometry::Pose body_from_camera = geometry::Pose::Identity();
  std::uint64_t segment = 0;  // poses of different ones have nothing to do with each other
};

/// What the odometry says of a time; nullopt where it says nothing.
using RobotOdometry = std::function<std::optional<OdometryPose>(std::int64_t stamp_ns)>;

/// What a robot's odometry says of the camera's motion, as far as vision has found it right.
///
/// Vision is compared with it over windows of half a second: the innovation of their motions has to pass a χ²
/// test. Where it does, a Kalman filter takes from it the scale of the odometry. It is trusted while the last
/// window in which something moved has passed, and the last five together, and its scale is known; so an
/// odometry that slips a lot, stands still or is mounted another way is not. Covariances that robots tell are
/// not used: most are placeholders.
class OdometryPrior {
 public:
  /// Of the camera since the pose that the window began with.
  struct Motion {
    geometry::Pose begin_from_camera = geometry::Pose::Identity();
    Matrix6 covariance = Matrix6::Zero();  // of a motion of the camera in its own frame
  };

  /// @param odometry  empty: nothing is ever told.
  explicit OdometryPrior(RobotOdometry odometry) : odometry_(std::move(odometry)) {}

  /// A picture was taken: goes on to its time.
  void go_to(std::int64_t stamp_ns);
  /// The camera's motion since the window began; nullopt where it is not known or trusted, or known to worse
  /// than kMaxSigma….
  [[nodiscard]] std::optional<Motion> since_begin() const;

  /// Vision is sure of the camera's pose. @param begin_from_camera  its motion since the window began.
  /// @return true if a window begins with this pose.
  bool observe(const geometry::Pose& begin_from_camera);
  /// A window begins with the camera's pose, which has nothing to do with those before.
  void begin_window();

  [[nodiscard]] bool is_trusted() const;
  /// By what the odometry's way and turning are multiplied, as known by now.
  [[nodiscard]] const OdometryScale& scale() const { return scale_; }

 private:
  struct Window {
    geometry::Pose body_from_camera;  // at its begin
    OdometryPath path;
  };
  void learn(const geometry::Pose& begin_from_camera);
  void forget_scale();
  [[nodiscard]] bool are_consistent() const;

  RobotOdometry odometry_;
  std::optional<OdometryPose> now_;
  std::int64_t now_ns_ = 0;
  std::optional<Window> window_;
  OdometryScale scale_ = OdometryScale::Ones();
  Eigen::Matrix2d scale_covariance_ = initial_scale_covariance();
  std::deque<double> innovations_;  // squared, normalised, of the last windows in which something moved

  static Eigen::Matrix2d initial_scale_covariance();
};

}  // namespace rds::tracker
