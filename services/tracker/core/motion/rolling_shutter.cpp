// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/motion/rolling_shutter.hpp"

namespace rds::tracker {
void remove_rolling_shutter(const geometry::CameraModel& camera, const ShutterMotion& motion,
                            std::vector<Feature>& features) {
  if (motion.readout_s == 0 || motion.velocity.isZero(0)) return;
  Twist rotation = motion.velocity;
  rotation.head<3>().setZero();
  for (Feature& f : features) {
    const bool measured = f.depth_m > 0;
    const double depth = measured ? static_cast<double>(f.depth_m) : 1;
    const double time = row_share(camera, static_cast<double>(f.image_px.y())) * motion.readout_s;
    const Eigen::Vector3d seen = depth * camera.ray_of_undistorted(f.px.cast<double>());
    const Eigen::Vector3d p = seen - time * point_velocity(measured ? motion.velocity : rotation, seen);
    if (p.z() <= 0) continue;
    f.px = camera.project_undistorted(p).cast<float>();
    if (measured) f.depth_m = static_cast<float>(p.z());
  }
}

Eigen::Vector2d project_rolling(const geometry::CameraModel& camera, const ShutterMotion& motion,
                                const Eigen::Vector3d& p) {
  Eigen::Vector2d px = camera.project(p);
  if (motion.readout_s == 0) return px;
  const double time = row_share(camera, px.y()) * motion.readout_s;
  const Eigen::Vector3d moved = p + time * point_velocity(motion.velocity, p);
  return moved.z() > 0 ? camera.project(moved) : px;
}

Eigen::Vector3d shutter_effect(const geometry::CameraModel& camera, const Twist& velocity,
                               const Feature& feature) {
  if (feature.depth_m <= 0) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d p =
      static_cast<double>(feature.depth_m) * camera.ray_of_undistorted(feature.px.cast<double>());
  return row_share(camera, static_cast<double>(feature.image_px.y())) * point_velocity(velocity, p);
}

}  // namespace rds::tracker
