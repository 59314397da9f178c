// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/removal/background_planes.hpp"

#include <Eigen/Geometry>

#include "services/tracker/core/removal/plane_fitting.hpp"
#include "services/tracker/core/removal/surface_growth.hpp"

namespace rds::tracker {
namespace {

constexpr int kStride = 2;  // cells, between those that are asked for planes
constexpr double kStepToNeighbourM = 0.08;

/// The cells of a picture as points of surfaces.
class CellSurfaces {
 public:
  CellSurfaces(const cv::Mat1f& depth_m, const GridGeometry& grid) : depth_m_(depth_m), grid_(grid) {}

  [[nodiscard]] Eigen::Vector3f point(int column, int row) const {
    return depth_m_(row, column) * grid_.ray(column, row);
  }

  /// Of the surface between the four neighbours; zero where they are not of one surface.
  [[nodiscard]] Eigen::Vector3f normal(int column, int row) const {
    const bool inside = column > 0 && row > 0 && column + 1 < depth_m_.cols && row + 1 < depth_m_.rows;
    const float z = inside ? depth_m_(row, column) : 0;
    const auto joined = [&](float neighbour_m) {
      return neighbour_m > 0 && one_surface(neighbour_m, z, kStepToNeighbourM);
    };
    if (!inside || !joined(depth_m_(row, column + 1)) || !joined(depth_m_(row, column - 1)) ||
        !joined(depth_m_(row + 1, column)) || !joined(depth_m_(row - 1, column)))
      return Eigen::Vector3f::Zero();
    return (point(column + 1, row) - point(column - 1, row))
        .cross(point(column, row + 1) - point(column, row - 1));
  }

 private:
  const cv::Mat1f& depth_m_;
  const GridGeometry& grid_;
};

}  // namespace

void mark_planes(const cv::Mat1f& depth_m, const GridGeometry& grid, const cv::Mat1b& suspect,
                 cv::Mat1b& background, cv::Mat1b& wide) {
  const CellSurfaces surfaces(depth_m, grid);
  std::vector<SurfaceSample> outside;
  outside.reserve(depth_m.total() / (kStride * kStride));
  for (int r = 0; r < depth_m.rows; r += kStride)
    for (int c = 0; c < depth_m.cols; c += kStride)
      if (depth_m(r, c) > 0 && (suspect(r, c) == 0 || background(r, c) != 0))
        outside.push_back({surfaces.point(c, r), surfaces.normal(c, r)});
  for (const Plane& plane : fit_planes(std::move(outside)))
    for (int r = 0; r < depth_m.rows; ++r)
      for (int c = 0; c < depth_m.cols; ++c) {
        std::uint8_t& told = plane.wide ? wide(r, c) : background(r, c);  // wide is background, too
        if (told != 0 || !(depth_m(r, c) > 0) || !is_near(plane, surfaces.point(c, r)) ||
            !is_parallel(plane, surfaces.normal(c, r)))
          continue;
        background(r, c) = 255;
        told = 255;
      }
}

}  // namespace rds::tracker
