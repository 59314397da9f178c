// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/level/level_pose.hpp"

namespace rds::tracker {
namespace {
constexpr double kSteep = .99;  // cosine of the angle from the vertical, 8°, below which no yaw can be told
}

geometry::Pose level_pose(const Eigen::Vector3d& up_in_camera) {
  const double along = up_in_camera.z();
  const Eigen::Vector3d ahead =
      std::abs(along) < kSteep ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d(-Eigen::Vector3d::UnitY());
  geometry::Pose camera_from_map = geometry::Pose::Identity();
  const Eigen::Vector3d z = up_in_camera.normalized();
  const Eigen::Vector3d x = (ahead - ahead.dot(z) * z).normalized();
  camera_from_map.linear() << x, z.cross(x), z;
  return camera_from_map.inverse();
}

}  // namespace rds::tracker
