// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/removal/background.hpp"

#include <algorithm>

#include <Eigen/Geometry>

#include "services/tracker/core/removal/surface_growth.hpp"

namespace rds::tracker {
namespace {

constexpr int kStride = 2;  // cells, between those that are asked for planes
constexpr double kStepToNeighbourM = 0.08;

}  // namespace

Background::Background(const PictureCells& picture, const GridGeometry& grid, const cv::Mat1b& suspect)
    : picture_(picture), grid_(grid), planes_(fit_planes(samples_outside(suspect))) {}

std::vector<SurfaceSample> Background::samples_outside(const cv::Mat1b& suspect) const {
  const cv::Mat1f& depth_m = picture_.depth_m;
  std::vector<SurfaceSample> samples;
  samples.reserve(depth_m.total() / (kStride * kStride));
  for (int r = 0; r < depth_m.rows; r += kStride)
    for (int c = 0; c < depth_m.cols; c += kStride)
      if (depth_m(r, c) > 0 && (suspect(r, c) == 0 || picture_.lasting(r, c) != 0))
        samples.push_back({point(c, r), normal(c, r)});
  return samples;
}

bool Background::shows(const cv::Point& cell, bool wide) const {
  if (picture_.lasting(cell) != 0) return true;
  if (!(picture_.depth_m(cell) > 0)) return false;
  const Eigen::Vector3f p = point(cell.x, cell.y);
  const auto may_show = [&](const Plane& plane) { return (plane.wide || !wide) && is_near(plane, p); };
  if (std::ranges::none_of(planes_, may_show)) return false;
  const Eigen::Vector3f n = normal(cell.x, cell.y);
  return std::ranges::any_of(planes_,
                             [&](const Plane& plane) { return may_show(plane) && is_parallel(plane, n); });
}

Eigen::Vector3f Background::point(int column, int row) const {
  return picture_.depth_m(row, column) * grid_.ray(column, row);
}

/// Of the surface between the four neighbours; zero where they are not of one surface.
Eigen::Vector3f Background::normal(int column, int row) const {
  const cv::Mat1f& depth_m = picture_.depth_m;
  const bool inside = column > 0 && row > 0 && column + 1 < depth_m.cols && row + 1 < depth_m.rows;
  const float z = inside ? depth_m(row, column) : 0;
  const auto joined = [&](float neighbour_m) {
    return neighbour_m > 0 && one_surface(neighbour_m, z, kStepToNeighbourM);
  };
  if (!inside || !joined(depth_m(row, column + 1)) || !joined(depth_m(row, column - 1)) ||
      !joined(depth_m(row + 1, column)) || !joined(depth_m(row - 1, column)))
    return Eigen::Vector3f::Zero();
  return (point(column + 1, row) - point(column - 1, row))
      .cross(point(column, row + 1) - point(column, row - 1));
}

}  // namespace rds::tracker
