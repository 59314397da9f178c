// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "common/geometry/pose.hpp"
#include "services/tracker/core/motion/se3.hpp"

namespace rds::tracker {

/// What the motion model says about the pose of one frame.
class MotionPrediction {
 public:
  /// No frame had a pose yet.
  MotionPrediction() : MotionPrediction(geometry::Pose::Identity(), std::nullopt, kNever) {}
  /// @param velocity  of the camera per second: camera_from_map moves by exp(velocity · dt). nullopt:
  /// unknown.
  /// @param gap_s     since the last pose.
  MotionPrediction(const geometry::Pose& last_map_from_camera, const std::optional<Twist>& velocity,
                   double gap_s);

  /// camera_from_map as expected, else by constant velocity; the last pose where the velocity is unknown or
  /// the gap too long.
  [[nodiscard]] const geometry::Pose& camera_from_map() const { return camera_from_map_; }
  [[nodiscard]] const geometry::Pose& last_map_from_camera() const { return last_map_from_camera_; }
  /// Time since the last pose [s]; infinite before the first one.
  [[nodiscard]] double gap_s() const { return gap_s_; }
  /// Velocity at the frame [m/s, rad/s]; zero where it is unknown.
  [[nodiscard]] Twist velocity() const;
  /// Mean velocity from the last pose to this one; nullopt where that was too long ago.
  [[nodiscard]] std::optional<Twist> velocity_to(const geometry::Pose& camera_from_map) const;
  /// True where no camera can have moved from the last pose to this one.
  [[nodiscard]] bool is_jump(const geometry::Pose& camera_from_map) const;
  /// False of places that are too far from the last pose for a camera that walked on since.
  [[nodiscard]] bool can_be_near(const geometry::Pose& map_from_other) const;
  /// Innovation of a pose: its distance from the prediction, relative to the largest one that the
  /// accelerations of a hand-held camera explain. Above 1 the pose may be that of something moving.
  [[nodiscard]] double innovation(const geometry::Pose& camera_from_map) const;
  /// Sensors say where the camera is: they know better than constant velocity.
  void expect(const geometry::Pose& camera_from_map) { camera_from_map_ = camera_from_map; }
  /// The same of its turn since the last pose (last_from_now); its place stays where constant velocity has
  /// it.
  void expect_turn(const Eigen::Quaterniond& turn);

 private:
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  geometry::Pose last_map_from_camera_;
  std::optional<Twist> velocity_;
  double gap_s_;
  geometry::Pose camera_from_map_;
};

/// Constant-velocity model of the camera (Mur-Artal et al. 2015, §V-B).
class MotionModel {
 public:
  /// @param last_map_from_camera  the last observed pose, as the map stands now.
  [[nodiscard]] MotionPrediction predict(const geometry::Pose& last_map_from_camera,
                                         std::int64_t time_ns) const;
  /// Takes in a pose that was found. @param is_continuous  false after a relocalisation: tells no velocity.
  void observe(const MotionPrediction& prediction, const geometry::Pose& camera_from_map,
               bool is_continuous) {
    velocity_ = is_continuous ? prediction.velocity_to(camera_from_map) : std::nullopt;
  }
  /// Later predictions start from the pose at this time.
  void start_from(std::int64_t time_ns) { last_time_ns_ = time_ns; }
  void forget_velocity() { velocity_.reset(); }

 private:
  std::optional<std::int64_t> last_time_ns_;
  std::optional<Twist> velocity_;
};

}  // namespace rds::tracker
