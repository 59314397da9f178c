// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/rendering/silhouette.hpp"

#include <algorithm>
#include <map>

#include "tools/simulator/rendering/rasterizer.hpp"

namespace rds::simulator {

double silhouette_area(const Mesh& mesh, const geometry::CameraModel& camera,
                       const geometry::Pose& camera_from_world) {
  Eigen::AlignedBox2d extent;
  for (const auto& vertex : mesh.vertices) {
    const Eigen::Vector3d p = camera_from_world * vertex.position.cast<double>();
    if (p.z() > 0.15)
      extent.extend(camera.project_undistorted(p).cwiseMax(-4000.0).cwiseMin(4000.0 + camera.width));
  }
  if (extent.isEmpty()) return 0;
  // A sample stands for 4×4 pixels: an eighth of the size, sampled twice per pixel.
  constexpr double kScale = 8;
  geometry::CameraModel small;
  small.width = static_cast<int>(extent.sizes().x() / kScale) + 3;
  small.height = static_cast<int>(extent.sizes().y() / kScale) + 3;
  small.fx = camera.fx / kScale;
  small.fy = camera.fy / kScale;
  small.cx = (camera.cx - extent.min().x()) / kScale + 1;
  small.cy = (camera.cy - extent.min().y()) / kScale + 1;
  Rasterizer rasterizer(small);
  rasterizer.clear();
  rasterizer.draw(mesh, camera_from_world);
  int samples = 0;
  for (int y = 0; y < rasterizer.height(); ++y)
    for (int x = 0; x < rasterizer.width(); ++x) samples += rasterizer.at(x, y) != 0 ? 1 : 0;
  return samples * kScale * kScale / 4;
}

std::vector<VisiblePart> visible_objects(const cv::Mat& object, const cv::Mat& depth) {
  struct Part {
    int x0 = 1 << 20;
    int y0 = 1 << 20;
    int x1 = 0;
    int y1 = 0;
    std::vector<float> depths;
  };
  std::map<std::uint16_t, Part> parts;
  for (int y = 0; y < object.rows; ++y)
    for (int x = 0; x < object.cols; ++x) {
      const auto id = object.at<std::uint16_t>(y, x);
      if (id == 0) continue;
      Part& part = parts[id];
      part.x0 = std::min(part.x0, x);
      part.y0 = std::min(part.y0, y);
      part.x1 = std::max(part.x1, x + 1);
      part.y1 = std::max(part.y1, y + 1);
      part.depths.push_back(depth.at<float>(y, x));
    }
  std::vector<VisiblePart> out;
  for (auto& [id, part] : parts) {
    const auto middle = part.depths.begin() + static_cast<std::ptrdiff_t>(part.depths.size() / 2);
    std::nth_element(part.depths.begin(), middle, part.depths.end());
    out.push_back({id, cv::Rect(part.x0, part.y0, part.x1 - part.x0, part.y1 - part.y0),
                   static_cast<int>(part.depths.size()), static_cast<double>(*middle)});
  }
  return out;
}

}  // namespace rds::simulator
