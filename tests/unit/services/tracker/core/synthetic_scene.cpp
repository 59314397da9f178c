// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/services/tracker/core/synthetic_scene.hpp"

#include <cmath>

#include <opencv2/imgproc.hpp>

namespace rds::tracker::test {
namespace {

constexpr double kWallDepth = 2;         // m
constexpr double kTexelsPerMetre = 160;  // as fine as the camera sees the wall
constexpr int kTexels = 1200;
constexpr double kStripM = 0.7;

const cv::Mat& texture() {
  static const cv::Mat kTexture = [] {
    std::mt19937 random(7);
    cv::Mat grey(kTexels, kTexels, CV_8UC1, cv::Scalar(128));
    for (int i = 0; i < 6000; ++i) {
      const cv::Point corner(static_cast<int>(random() % kTexels), static_cast<int>(random() % kTexels));
      const cv::Size size(4 + static_cast<int>(random() % 24), 4 + static_cast<int>(random() % 24));
      cv::rectangle(grey, cv::Rect(corner, size), cv::Scalar(static_cast<double>(random() % 256)),
                    cv::FILLED);
    }
    cv::Mat color;
    cv::cvtColor(grey, color, cv::COLOR_GRAY2BGR);
    return color;
  }();
  return kTexture;
}

/// Of all pixels, row by row; those of the camera asked for last are kept, for undistorting takes long.
const std::vector<Eigen::Vector3d>& rays_of(const geometry::CameraModel& camera) {
  static geometry::CameraModel known;
  static std::vector<Eigen::Vector3d> rays;
  if (known == camera) return rays;
  known = camera;
  rays.clear();
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) rays.push_back(camera.ray(Eigen::Vector2d(u, v)));
  return rays;
}

bool stands_out(double x) {
  return static_cast<int>(std::floor(x / kStripM)) % 2 != 0;
}

/// Depth at which a ray meets the wall, the side of a strip counting as the wall behind it [m].
double depth_along(const Pose& map_from_camera, const Eigen::Vector3d& ray, double relief_m) {
  const Eigen::Vector3d direction = map_from_camera.linear() * ray;
  const auto depth_to = [&](double wall_z) {
    return (wall_z - map_from_camera.translation().z()) / direction.z();
  };
  const double near = depth_to(kWallDepth - relief_m);
  const bool is_met = relief_m > 0 && stands_out(map_from_camera.translation().x() + near * direction.x());
  return is_met ? near : depth_to(kWallDepth);
}

/// Where a camera-frame point is when its row is read. The row depends on the place: a few steps find both.
Eigen::Vector3d when_its_row_is_read(const geometry::CameraModel& camera, const ShutterMotion& motion,
                                     const Eigen::Vector3d& p) {
  Eigen::Vector3d read = p;
  for (int i = 0; i < 10 && read.z() > 0; ++i)
    read = se3_exp(row_share(camera, camera.project(read).y()) * motion.readout_s * motion.velocity) * p;
  return read;
}

}  // namespace

geometry::CameraModel small_camera() {
  geometry::CameraModel camera;
  camera.width = 320;
  camera.height = 240;
  camera.fx = camera.fy = 300;
  camera.cx = 159.5;
  camera.cy = 119.5;
  return camera;
}

Pose pose(double x, double y, double z, double turn_rad) {
  return geometry::make_pose({x, y, z},
                             Eigen::Quaterniond(Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitY())));
}

Twist quick_motion() {
  Twist velocity;
  velocity << 0.2, -0.15, 0.15, 0.6, -0.6, 0.2;
  return velocity;
}

image::RgbdFrame picture_of_wall(const Pose& map_from_camera, std::int64_t stamp_ns,
                                 const geometry::CameraModel& camera, double relief_m) {
  image::RgbdFrame frame;
  frame.stamp_ns = stamp_ns;
  frame.camera = camera;
  const auto& rays = rays_of(camera);
  const cv::Size size(frame.camera.width, frame.camera.height);
  cv::Mat map_x(size, CV_32FC1);
  cv::Mat map_y(size, CV_32FC1);
  cv::Mat depth(size, CV_32FC1);
  for (int v = 0; v < size.height; ++v)
    for (int u = 0; u < size.width; ++u) {
      const Eigen::Vector3d& ray = rays[static_cast<std::size_t>(v * size.width + u)];
      const double z = depth_along(map_from_camera, ray, relief_m);
      const Eigen::Vector3d point = map_from_camera * (z * ray);
      map_x.at<float>(v, u) = static_cast<float>(point.x() * kTexelsPerMetre + kTexels / 2.0);
      map_y.at<float>(v, u) = static_cast<float>(point.y() * kTexelsPerMetre + kTexels / 2.0);
      depth.at<float>(v, u) = static_cast<float>(z);
    }
  cv::remap(texture(), frame.color.pixels, map_x, map_y, cv::INTER_LINEAR, cv::BORDER_REFLECT);
  frame.depth.values = depth;
  frame.depth.metres_per_unit = 1;
  return frame;
}

MovableMask mask_of(const cv::Rect& px) {
  const geometry::CameraModel camera = small_camera();
  cv::Mat1b cells(camera.height, camera.width, std::uint8_t{0});
  cells(px).setTo(255);
  return {cells, 1};
}

image::RgbdFrame dark_picture(std::int64_t stamp_ns) {
  image::RgbdFrame frame = picture_of_wall(Pose::Identity(), stamp_ns);
  frame.color.pixels.setTo(0);
  return frame;
}

std::vector<Eigen::Vector3d> random_points(std::size_t count, std::mt19937& random) {
  std::uniform_real_distribution<double> sideways(-1.2, 1.2);
  std::uniform_real_distribution<double> away(1.5, 3);
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < count; ++i)
    points.emplace_back(sideways(random), sideways(random), away(random));
  return points;
}

SyntheticView view_of(const std::vector<Eigen::Vector3d>& points, const Pose& map_from_camera,
                      double noise_px, std::mt19937& random, const ShutterMotion& motion) {
  std::normal_distribution<double> noise(0, noise_px > 0 ? noise_px : 1e-9);
  const geometry::CameraModel camera = small_camera();
  std::vector<Feature> features;
  SyntheticView view;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d p = when_its_row_is_read(camera, motion, map_from_camera.inverse() * points[i]);
    if (p.z() < 0.3) continue;
    const Eigen::Vector2d px = camera.project(p) + Eigen::Vector2d(noise(random), noise(random));
    if (px.x() < 0 || px.y() < 0 || px.x() > camera.width - 1 || px.y() > camera.height - 1) continue;
    Feature feature;
    feature.px = feature.image_px = px.cast<float>();
    feature.depth_m = static_cast<float>(p.z());
    std::mt19937 appearance(static_cast<unsigned>(i));
    for (auto& byte : feature.descriptor) byte = static_cast<std::uint8_t>(appearance());
    features.push_back(feature);
    view.point.push_back(i);
  }
  view.features = std::make_shared<const FeatureSet>(camera, std::move(features));
  return view;
}

}  // namespace rds::tracker::test
