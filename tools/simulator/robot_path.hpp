// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "common/geometry/pose.hpp"
#include "tools/simulator/world/floor_map.hpp"

namespace rds::simulator {

/// The camera of a robot that drives from room to room, looks around there, and comes back to places.
///
/// 1.2 m above the floor, a little downwards. Sampled once; a function of its arguments only.
class RobotPath {
 public:
  static constexpr double kCameraHeightM = 1.2;
  static constexpr double kSlowestM_s = 0.3;  // of cruising; it slows down to turn and to stop
  static constexpr double kFastestM_s = 0.8;
  static constexpr double kTurnRateRad_s = 1.04;  // never faster: 60°/s
  static constexpr double kClearanceM = 0.32;     // from its middle to walls and furniture

  /// @param scene  its first room is a corridor; the robot starts in its middle.
  RobotPath(const Scene& scene, double seconds, std::uint64_t seed);

  /// @param time_s  since the start; the last pose after the end.
  [[nodiscard]] geometry::Pose world_from_camera(double time_s) const;

 private:
  struct State {
    Eigen::Vector2d position = Eigen::Vector2d::Zero();  // in the world [m]
    double heading_rad = 0;                              // 0 = +x; not wrapped
  };
  static constexpr double kStepS = 1.0 / 60;

  friend class RobotDrive;

  std::vector<State> samples_;
};

}  // namespace rds::simulator
