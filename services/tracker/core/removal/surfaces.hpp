// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "services/tracker/core/removal/depth_grid.hpp"

namespace rds::tracker {

/// Largest step between neighbouring cells of one surface, 1 m away; beyond, it grows with depth squared. That
/// is ten times and more what noise makes, for slant, folds and rims (docs/decisions/depth-noise.md).
inline constexpr double kSurfaceStepM = 0.05;

/// Where a surface may go on to.
struct GrowthLimits {
  cv::Rect cells;  // inside the grid
  float min_depth_m = 0;
  float max_depth_m = 0;
  double step_m = kSurfaceStepM;
};

/// True if two neighbouring cells with these depths [m] can show one surface.
inline bool one_surface(float depth_a_m, float depth_b_m, double step_m) {
  const float nearer = std::min(depth_a_m, depth_b_m);
  return std::abs(depth_a_m - depth_b_m) <= static_cast<float>(step_m) * std::max(1.0F, nearer * nearer);
}

/// The surfaces that a picture shows, cell by cell. Depth [m] and grid must outlive it.
struct SurfaceCells {
  const cv::Mat1f& depth_m;
  const GridGeometry& grid;

  /// In the camera frame.
  [[nodiscard]] Eigen::Vector3f point(int column, int row) const {
    return depth_m(row, column) * grid.ray(column, row);
  }
  /// Of the surface between the four neighbours, of any length; zero where they are not of one surface.
  [[nodiscard]] Eigen::Vector3f normal(int column, int row) const;
};

/// Marks (255) in `mask` all cells within the limits that `seeds` (cells marked in `mask` already) are
/// connected with.
void grow_surface(const cv::Mat1f& depth_m, const GrowthLimits& limits, std::vector<cv::Point> seeds,
                  cv::Mat1b& mask);

/// The connected surfaces among the cells within the limits, the largest first.
std::vector<std::vector<cv::Point>> surfaces_within(const cv::Mat1f& depth_m, const GrowthLimits& limits);

}  // namespace rds::tracker
