// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/removal/surfaces.hpp"

#include <algorithm>
#include <array>

#include <Eigen/Geometry>

namespace rds::tracker {
namespace {

constexpr double kNormalStepM = 0.08;  // between neighbours that a normal is made of
const std::array<cv::Point, 4> kNeighbours{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};

bool is_within(const cv::Mat1f& depth_m, const GrowthLimits& limits, const cv::Point& cell) {
  if (!limits.cells.contains(cell)) return false;
  const float z = depth_m(cell);
  return z > 0 && z >= limits.min_depth_m && z <= limits.max_depth_m;
}

}  // namespace

Eigen::Vector3f SurfaceCells::normal(int column, int row) const {
  const bool inside = column > 0 && row > 0 && column + 1 < depth_m.cols && row + 1 < depth_m.rows;
  const float z = inside ? depth_m(row, column) : 0;
  const auto joined = [&](float neighbour_m) {
    return neighbour_m > 0 && one_surface(neighbour_m, z, kNormalStepM);
  };
  if (!inside || !joined(depth_m(row, column + 1)) || !joined(depth_m(row, column - 1)) ||
      !joined(depth_m(row + 1, column)) || !joined(depth_m(row - 1, column)))
    return Eigen::Vector3f::Zero();
  return (point(column + 1, row) - point(column - 1, row))
      .cross(point(column, row + 1) - point(column, row - 1));
}

void grow_surface(const cv::Mat1f& depth_m, const GrowthLimits& limits, std::vector<cv::Point> seeds,
                  cv::Mat1b& mask) {
  while (!seeds.empty()) {
    const cv::Point cell = seeds.back();
    seeds.pop_back();
    for (const cv::Point& step : kNeighbours) {
      const cv::Point next = cell + step;
      if (!is_within(depth_m, limits, next) || mask(next) != 0) continue;
      if (!one_surface(depth_m(cell), depth_m(next), limits.step_m)) continue;
      mask(next) = 255;
      seeds.push_back(next);
    }
  }
}

std::vector<std::vector<cv::Point>> surfaces_within(const cv::Mat1f& depth_m, const GrowthLimits& limits) {
  cv::Mat1b seen(depth_m.size(), std::uint8_t{0});
  std::vector<std::vector<cv::Point>> surfaces;
  for (int r = limits.cells.y; r < limits.cells.br().y; ++r)
    for (int c = limits.cells.x; c < limits.cells.br().x; ++c) {
      if (seen(r, c) != 0 || !is_within(depth_m, limits, {c, r})) continue;
      std::vector<cv::Point>& surface = surfaces.emplace_back();
      surface.emplace_back(c, r);
      seen(r, c) = 255;
      for (std::size_t i = 0; i < surface.size(); ++i)
        for (const cv::Point& step : kNeighbours) {
          const cv::Point next = surface[i] + step;
          if (!is_within(depth_m, limits, next) || seen(next) != 0) continue;
          if (!one_surface(depth_m(surface[i]), depth_m(next), limits.step_m)) continue;
          seen(next) = 255;
          surface.push_back(next);
        }
    }
  std::ranges::stable_sort(surfaces, std::ranges::greater{}, &std::vector<cv::Point>::size);
  return surfaces;
}

}  // namespace rds::tracker
