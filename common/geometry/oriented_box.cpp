// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/oriented_box.hpp"

namespace rds::geometry {

std::array<Eigen::Vector3d, 8> OrientedBox::corners() const {
  std::array<Eigen::Vector3d, 8> corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector3d sign((i & 1U) != 0 ? 1 : -1, (i & 2U) != 0 ? 1 : -1, (i & 4U) != 0 ? 1 : -1);
    corners[i] = map_from_box * (sign.cwiseProduct(size) / 2).eval();
  }
  return corners;
}

Box3 OrientedBox::axis_aligned_hull() const {
  const Eigen::Vector3d half = map_from_box.linear().cwiseAbs() * size / 2;
  return {center() - half, center() + half};
}

bool OrientedBox::contains(const Eigen::Vector3d& point_in_map) const {
  const Eigen::Vector3d offset = map_from_box.linear().transpose() * (point_in_map - center());
  return (offset.cwiseAbs().array() <= size.array() / 2).all();
}

bool is_valid(const OrientedBox& box) {
  return is_finite(box.map_from_box) && box.size.allFinite() && (box.size.array() > 0).all();
}

}  // namespace rds::geometry
