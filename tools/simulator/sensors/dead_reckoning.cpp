// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/sensors/dead_reckoning.hpp"

#include <cmath>

#include "tools/simulator/rendering/random.hpp"

namespace rds::simulator {
namespace {

constexpr std::uint64_t kStream = 4000;
constexpr double kNsPerSecond = 1e9;

}  // namespace

std::vector<geometry::StampedPose> dead_reckoning(std::span<const geometry::StampedPose> truth,
                                                  const DeadReckoningErrors& errors, std::uint64_t seed) {
  std::vector<geometry::StampedPose> told;
  Random random(seed, kStream);
  geometry::Pose odom_from_camera = geometry::Pose::Identity();
  double slips_until_s = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (i > 0) {
      const double now_s = static_cast<double>(truth[i].stamp_ns - truth[0].stamp_ns) / kNsPerSecond;
      const double step_s = static_cast<double>(truth[i].stamp_ns - truth[i - 1].stamp_ns) / kNsPerSecond;
      if (random.chance(errors.slips_per_second * step_s)) slips_until_s = now_s + errors.slip_s;
      const double scale = errors.scale * (now_s < slips_until_s ? 1 + errors.slip : 1);
      const geometry::Pose step = truth[i - 1].map_from_camera.inverse() * truth[i].map_from_camera;
      const Eigen::AngleAxisd turn(step.linear());
      const double way_root = std::sqrt(step.translation().norm());
      const double turn_root = std::sqrt(step.translation().norm() + turn.angle());
      const Eigen::Vector3d way =
          scale * step.translation() + errors.way_noise * way_root * random.normal_vector();
      const Eigen::Vector3d rotation =
          scale * turn.angle() * turn.axis() + errors.turn_noise_rad * turn_root * random.normal_vector();
      const double angle = rotation.norm();
      odom_from_camera =
          odom_from_camera * geometry::make_pose(way, Eigen::Quaterniond(Eigen::AngleAxisd(
                                                          angle, angle > 0 ? Eigen::Vector3d(rotation / angle)
                                                                           : Eigen::Vector3d::UnitX())));
    }
    told.push_back({truth[i].stamp_ns, odom_from_camera, truth[i].stamp_text});
  }
  return told;
}

}  // namespace rds::simulator
