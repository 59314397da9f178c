// SPDX-License-Identifier: Apache-2.0
#include "common/dynamic_segmentation/depth_grid.hpp"

#include <algorithm>
#include <limits>
#include <type_traits>

namespace rds::segmentation {
namespace {

constexpr int kColumns = 160;
constexpr double kFiner = 3;  // entries of the table per cell

/// Nearest of four pixels of every cell, in the picture's own unit; 0 without measurement.
template <class Value>
void fill(const cv::Mat& values, int cell_px, float metres_per_unit, float max_depth_m, cv::Mat1f& cells) {
  using Number = std::conditional_t<std::is_integral_v<Value>, int, float>;
  constexpr Number kNone = std::numeric_limits<Number>::max();
  const int first = cell_px / 4;
  const int second = std::min(cell_px - 1, first + std::max(1, cell_px / 2));
  const auto measured = [](Value value) { return value > 0 ? Number{value} : kNone; };  // not NaN
  for (int r = 0; r < cells.rows; ++r) {
    const Value* upper = values.ptr<Value>(std::min(values.rows - 1, r * cell_px + first));
    const Value* lower = values.ptr<Value>(std::min(values.rows - 1, r * cell_px + second));
    float* out = cells.ptr<float>(r);
    for (int c = 0; c < cells.cols; ++c) {
      const int left = std::min(values.cols - 1, c * cell_px + first);
      const int right = std::min(values.cols - 1, c * cell_px + second);
      const Number nearest = std::min(std::min(measured(upper[left]), measured(upper[right])),
                                      std::min(measured(lower[left]), measured(lower[right])));
      const float z = static_cast<float>(nearest) * metres_per_unit;
      out[c] = nearest < kNone && z <= max_depth_m ? z : 0;
    }
  }
}

}  // namespace

GridGeometry::GridGeometry(const geometry::CameraModel& camera, const geometry::DepthNoise& noise,
                           int at_least_px)
    : camera_(camera), noise_(noise), cell_px_(std::max(at_least_px, camera.width / kColumns)) {
  size_ = {(camera.width + cell_px_ - 1) / cell_px_, (camera.height + cell_px_ - 1) / cell_px_};
  rays_.reserve(static_cast<std::size_t>(size_.area()));
  const double middle = (cell_px_ - 1) / 2.0;
  for (int r = 0; r < size_.height; ++r)
    for (int c = 0; c < size_.width; ++c)
      rays_.push_back(camera.ray({c * cell_px_ + middle, r * cell_px_ + middle}).cast<float>());
  make_tables();
}

void GridGeometry::make_tables() {
  Eigen::Vector2f highest = table_corner_ = rays_.front().head<2>();
  for (const Eigen::Vector3f& ray : rays_) {
    if (!ray.allFinite()) continue;
    table_corner_ = table_corner_.cwiseMin(ray.head<2>());
    highest = highest.cwiseMax(ray.head<2>());
  }
  table_per_ray_ = static_cast<float>(kFiner * camera_.fx / cell_px_);
  const Eigen::Vector2f extent = (highest - table_corner_) * table_per_ray_;
  table_size_ = {static_cast<int>(extent.x()) + 1, static_cast<int>(extent.y()) + 1};
  for (int x = 0; x < table_size_.width; ++x) column_table_.push_back(cell_of_entry(x, 0).x);
  for (int y = 0; y < table_size_.height; ++y) row_table_.push_back(cell_of_entry(0, y).y);
  if (!camera_.has_distortion()) return;
  cell_table_.create(table_size_);
  for (int y = 0; y < cell_table_.rows; ++y)
    for (int x = 0; x < cell_table_.cols; ++x) {
      const cv::Point cell = cell_of_entry(x, y);
      cell_table_(y, x) = cell.x < 0 || cell.y < 0 ? -1 : cell.y * size_.width + cell.x;
    }
}

/// Column and row; -1 for what is outside the picture.
cv::Point GridGeometry::cell_of_entry(int x, int y) const {
  const Eigen::Vector2f entry(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
  const Eigen::Vector2d ray = (table_corner_ + entry / table_per_ray_).cast<double>();
  const Eigen::Vector2d px = camera_.project({ray.x(), ray.y(), 1}) / cell_px_;
  const auto within = [](double at, int size) { return at >= 0 && at < size ? static_cast<int>(at) : -1; };
  return {within(px.x(), size_.width), within(px.y(), size_.height)};
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

}  // namespace rds::segmentation
