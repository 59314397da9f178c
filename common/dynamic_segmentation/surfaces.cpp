// SPDX-License-Identifier: Apache-2.0
#include "common/dynamic_segmentation/surfaces.hpp"

#include <Eigen/Geometry>

namespace rds::segmentation {

Eigen::Vector3f SurfaceCells::normal(int column, int row) const {
  constexpr double kNormalStepM = 0.08;  // between neighbours that a normal is made of
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

}  // namespace rds::segmentation
