// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/removal/depth_grid.hpp"

#include <algorithm>

namespace rds::tracker {
namespace {

constexpr int kColumns = 160;
constexpr double kFiner = 3;  // entries of the table per cell

/// Nearest of four pixels of every cell, in the picture's own unit; 0 without measurement.
template <class Value>
void fill(const cv::Mat& values, int cell_px, float metres_per_unit, float max_depth_m, cv::Mat1f& cells) {
  const int first = cell_px / 4;
  const int second = std::min(cell_px - 1, first + std::max(1, cell_px / 2));
  for (int r = 0; r < cells.rows; ++r) {
    const Value* upper = values.ptr<Value>(std::min(values.rows - 1, r * cell_px + first));
    const Value* lower = values.ptr<Value>(std::min(values.rows - 1, r * cell_px + second));
    float* out = cells.ptr<float>(r);
    for (int c = 0; c < cells.cols; ++c) {
      const int left = std::min(values.cols - 1, c * cell_px + first);
      const int right = std::min(values.cols - 1, c * cell_px + second);
      float nearest = max_depth_m;
      bool any = false;
      for (const Value value : {upper[left], upper[right], lower[left], lower[right]}) {
        const float z = static_cast<float>(value) * metres_per_unit;
        if (!(z > 0) || z > nearest) continue;  // NaN too
        nearest = z;
        any = true;
      }
      out[c] = any ? nearest : 0;
    }
  }
}

}  // namespace

GridGeometry::GridGeometry(const geometry::CameraModel& camera)
    : camera_(camera), cell_px_(std::max(1, camera.width / kColumns)) {
  size_ = {(camera.width + cell_px_ - 1) / cell_px_, (camera.height + cell_px_ - 1) / cell_px_};
  rays_.reserve(static_cast<std::size_t>(size_.area()));
  const double middle = (cell_px_ - 1) / 2.0;
  for (int r = 0; r < size_.height; ++r)
    for (int c = 0; c < size_.width; ++c)
      rays_.push_back(camera.ray({c * cell_px_ + middle, r * cell_px_ + middle}).cast<float>());
  make_cell_table();
}

void GridGeometry::make_cell_table() {
  Eigen::Vector2f highest = table_corner_ = rays_.front().head<2>();
  for (const Eigen::Vector3f& ray : rays_) {
    if (!ray.allFinite()) continue;
    table_corner_ = table_corner_.cwiseMin(ray.head<2>());
    highest = highest.cwiseMax(ray.head<2>());
  }
  table_per_ray_ = static_cast<float>(kFiner * camera_.fx / cell_px_);
  const Eigen::Vector2f extent = (highest - table_corner_) * table_per_ray_;
  cell_table_.create(static_cast<int>(extent.y()) + 1, static_cast<int>(extent.x()) + 1);
  for (int y = 0; y < cell_table_.rows; ++y)
    for (int x = 0; x < cell_table_.cols; ++x) {
      const Eigen::Vector2d ray =
          (table_corner_ +
           Eigen::Vector2f(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F) / table_per_ray_)
              .cast<double>();
      const Eigen::Vector2d px = camera_.project({ray.x(), ray.y(), 1}) / cell_px_;
      const bool inside = px.x() >= 0 && px.y() >= 0 && px.x() < size_.width && px.y() < size_.height;
      cell_table_(y, x) = inside ? static_cast<int>(px.y()) * size_.width + static_cast<int>(px.x()) : -1;
    }
}

cv::Mat1f depth_in_cells(const image::DepthImage& depth, const GridGeometry& grid, double max_depth_m) {
  cv::Mat1f cells(grid.size());
  const auto farthest = static_cast<float>(max_depth_m);
  if (depth.values.type() == CV_16UC1)
    fill<std::uint16_t>(depth.values, grid.cell_px(), depth.metres_per_unit, farthest, cells);
  else
    fill<float>(depth.values, grid.cell_px(), depth.metres_per_unit, farthest, cells);
  return cells;
}

}  // namespace rds::tracker
