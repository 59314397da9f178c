// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "common/geometry/pose.hpp"

namespace rds::simulator {

/// Pose of a camera at `eye` that looks at `target`, its x axis horizontal; the direction is not vertical.
geometry::Pose look_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& target);

/// How the camera moves; the first four are those of TUM's walking sequences (Sturm et al., IROS 2012).
enum class PathKind {
  kStatic,      // held still by hand
  kXyz,         // moved along the three axes, direction kept
  kRpy,         // turned about the three axes, place kept
  kHalfsphere,  // over a half sphere of one metre diameter, looking at the desk
  kLoop         // around the room and back to the start
};

std::optional<PathKind> path_kind(const std::string& name);
/// The names that path_kind() knows, separated by |.
std::string path_names();

/// A handheld camera's pose over time: smooth, with the tremor of a hand. A function of its arguments only.
class CameraPath {
 public:
  /// @param seconds  length of the recording; `loop` closes within it.
  CameraPath(PathKind kind, double seconds, std::uint64_t seed);

  /// @param time_s  since the start.
  [[nodiscard]] geometry::Pose world_from_camera(double time_s) const;

 private:
  struct View {
    Eigen::Vector3d eye;
    Eigen::Vector3d target;
    Eigen::Vector3d turn;  // pitch, yaw, roll in the camera frame [rad]
  };
  [[nodiscard]] View view(double time_s) const;
  /// Tremor of channel 0 … 5, about −1 … 1.
  [[nodiscard]] double tremor(int channel, double time_s) const;

  PathKind kind_;
  double seconds_;
  Eigen::Vector3d eye_;
  Eigen::Vector3d target_;
  std::array<double, 6> phase_;
  std::array<double, 6> pace_;
};

}  // namespace rds::simulator
