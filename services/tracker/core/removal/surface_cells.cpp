// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/removal/surface_cells.hpp"

#include <Eigen/Geometry>

#include "services/tracker/core/removal/surface_growth.hpp"

namespace rds::tracker {
namespace {

constexpr double kStepToNeighbourM = 0.08;

}  // namespace

Eigen::Vector3f SurfaceCells::normal(int column, int row) const {
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
