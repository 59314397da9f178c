// SPDX-License-Identifier: Apache-2.0
#include "tools/evaluation/visits/depth_views.hpp"

#include <cmath>

#include "common/geometry/trajectory.hpp"
#include "common/image/camera_yaml.hpp"
#include "common/image/picture_file.hpp"
#include "common/image/tum_list.hpp"

namespace rds::evaluation {
namespace {

constexpr double kNearestM = 0.4;
constexpr double kFarthestM = 4.0;
constexpr double kWidest = 2;  // tangent; no camera of ours sees so far aside

/// A depth picture and where it was taken.
struct DepthPicture {
  cv::Mat depth;
  geometry::CameraModel camera;
  double depth_scale = 0;
  geometry::Pose camera_from_world;

  /// Depth [m] in the direction of a point; 0 where nothing is measured or the point is not in the picture.
  [[nodiscard]] double depth_at(const Eigen::Vector3d& in_camera) const {
    const Eigen::Vector2d pixel = camera.project(in_camera);
    const double x = std::round(pixel.x());
    const double y = std::round(pixel.y());
    if (!(x >= 0 && y >= 0 && x < camera.width && y < camera.height)) return 0;
    return depth.at<std::uint16_t>(static_cast<int>(y), static_cast<int>(x)) / depth_scale;
  }
};

void look(const DepthPicture& picture, std::span<const Eigen::Vector3d> points, double tolerance_m,
          std::vector<PointViews>& views) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d in_camera = picture.camera_from_world * points[i];
    const double z = in_camera.z();
    if (!(z > kNearestM && z < kFarthestM) || in_camera.head<2>().norm() > kWidest * z) continue;
    const double measured = picture.depth_at(in_camera);
    if (measured <= 0) continue;
    if (std::abs(measured - z) <= tolerance_m) ++views[i].on_surface;
    if (measured > z + tolerance_m) ++views[i].seen_through;
  }
}

}  // namespace

tl::expected<std::vector<PointViews>, std::string> look_at(std::span<const Eigen::Vector3d> points,
                                                           const std::filesystem::path& recording,
                                                           const DepthViewsOptions& options) {
  const auto poses = geometry::read_trajectory(recording / "groundtruth.txt");
  if (!poses) return tl::unexpected(poses.error());
  const auto description = image::read_camera_yaml(recording / "camera.yaml");
  if (!description) return tl::unexpected(description.error());
  const auto pictures = image::read_tum_list(recording / "depth.txt");
  if (!pictures) return tl::unexpected(pictures.error());
  DepthPicture picture{{}, description->camera, description->depth_scale, geometry::Pose::Identity()};
  std::vector<PointViews> views(points.size());
  for (std::size_t n = 0; n < pictures->entries.size(); n += static_cast<std::size_t>(options.every)) {
    const auto& entry = pictures->entries[n];
    auto depth = image::read_depth_picture(entry.picture, {picture.camera.width, picture.camera.height});
    if (!depth) return tl::unexpected(depth.error());
    picture.depth = std::move(*depth);
    picture.camera_from_world = geometry::interpolate(*poses, entry.stamp_ns).inverse();
    look(picture, points, options.tolerance_m, views);
  }
  return views;
}

}  // namespace rds::evaluation
