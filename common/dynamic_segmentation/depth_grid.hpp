// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "common/geometry/camera_model.hpp"
#include "common/geometry/depth_noise.hpp"
#include "common/image/rgbd_frame.hpp"

namespace rds::segmentation {

/// How a camera's pictures are divided into square cells, at most some 160 across, and how well it measures
/// depth.
class GridGeometry {
 public:
  using Numbers = Eigen::Array<float, Eigen::Dynamic, 1, 0, 256, 1>;  // of some points
  using Cells = Eigen::Array<int, Eigen::Dynamic, 1, 0, 256, 1>;

  GridGeometry() = default;
  /// @param at_least_px  of a cell's side.
  explicit GridGeometry(const geometry::CameraModel& camera,
                        const geometry::DepthNoise& noise = geometry::kDepthNoises.front(),
                        int at_least_px = 1);

  [[nodiscard]] const geometry::CameraModel& camera() const { return camera_; }
  [[nodiscard]] const geometry::DepthNoise& noise() const { return noise_; }
  [[nodiscard]] int cell_px() const { return cell_px_; }
  [[nodiscard]] cv::Size size() const { return size_; }
  /// Ray (x, y, 1) through the middle of a cell.
  [[nodiscard]] const Eigen::Vector3f& ray(int column, int row) const {
    return rays_[static_cast<std::size_t>(row * size_.width + column)];
  }
  /// Index, row by row, of the cell in which a point in the camera frame shows, to about a third of a cell;
  /// -1 outside the picture.
  [[nodiscard]] int index_of(const Eigen::Vector3f& point_in_camera) const {
    if (!(point_in_camera.z() > kNearestM)) return -1;
    const float per_m = 1 / point_in_camera.z();
    const int x = static_cast<int>((point_in_camera.x() * per_m - table_corner_.x()) * table_per_ray_);
    const int y = static_cast<int>((point_in_camera.y() * per_m - table_corner_.y()) * table_per_ray_);
    return index_at(x, y);
  }
  /// The same of points with these coordinates.
  [[nodiscard]] Cells indices_of(const Numbers& x_m, const Numbers& y_m, const Numbers& z_m) const {
    const Numbers per_m = 1 / z_m;
    const Cells x = ((x_m * per_m - table_corner_.x()) * table_per_ray_).cast<int>();
    const Cells y = ((y_m * per_m - table_corner_.y()) * table_per_ray_).cast<int>();
    Cells cells(z_m.size());
    for (Eigen::Index i = 0; i < cells.size(); ++i) cells[i] = z_m[i] > kNearestM ? index_at(x[i], y[i]) : -1;
    return cells;
  }
  /// The same cell; (-1, -1) outside the picture.
  [[nodiscard]] cv::Point cell_of(const Eigen::Vector3f& point_in_camera) const {
    const int index = index_of(point_in_camera);
    return index < 0 ? cv::Point(-1, -1) : cv::Point(index % size_.width, index / size_.width);
  }

 private:
  geometry::CameraModel camera_;
  geometry::DepthNoise noise_ = geometry::kDepthNoises.front();
  int cell_px_ = 1;
  cv::Size size_;
  static constexpr float kNearestM = 0.1F;

  [[nodiscard]] int index_at(int x, int y) const {
    if (x < 0 || y < 0 || x >= table_size_.width || y >= table_size_.height) return -1;
    if (cell_table_.data != nullptr) return cell_table_(y, x);
    const int column = column_table_[static_cast<std::size_t>(x)];
    const int row = row_table_[static_cast<std::size_t>(y)];
    return column < 0 || row < 0 ? -1 : row * size_.width + column;
  }
  void make_tables();
  [[nodiscard]] cv::Point cell_of_entry(int x, int y) const;

  std::vector<Eigen::Vector3f> rays_;
  std::vector<int> column_table_;  // by ray; -1 outside the picture
  std::vector<int> row_table_;
  cv::Mat1i cell_table_;  // by ray, where the picture is distorted; it hardly fits the processor's cache
  cv::Size table_size_;
  Eigen::Vector2f table_corner_ = Eigen::Vector2f::Zero();
  float table_per_ray_ = 0;
};

/// A picture in cells.
struct PictureCells {
  cv::Mat1f depth_m;
  cv::Mat1b stable;   // 255 where something shows that has stood still for long
  cv::Mat1w colours;  // colours_in_cells(); empty where they say nothing
};

/// Depth [m] of what stands nearest in each cell; 0 where nothing was measured or all is beyond max_depth_m.
cv::Mat1f depth_in_cells(const image::DepthImage& depth, const GridGeometry& grid, double max_depth_m);

}  // namespace rds::segmentation
