// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/segmentation/near_points.hpp"

#include <algorithm>

namespace rds::mapper {
namespace {

constexpr int kCubes = 4;  // per radius

/// Of a ball's cubes so far aside of its middle in both other directions: how far they reach; below 0: none.
int reach_at(int y, int z) {
  int reach = kCubes;
  while (reach >= 0 && reach * reach + y * y + z * z > kCubes * kCubes) --reach;
  return reach;
}

}  // namespace

NearPoints::NearPoints(const std::vector<Eigen::Vector3f>& points, float radius_m)
    : side_m_(radius_m / kCubes) {
  Eigen::Vector3f highest = points.front();
  lowest_ = points.front();
  for (const auto& p : points) {
    lowest_ = lowest_.cwiseMin(p);
    highest = highest.cwiseMax(p);
  }
  lowest_.array() -= radius_m;
  size_ = ((highest - lowest_) / side_m_).array().floor().cast<int>() + kCubes + 1;
  near_.resize(static_cast<std::size_t>(size_.prod()));
  std::vector<bool> filled(near_.size(), false);
  for (const auto& p : points) {
    const Eigen::Array3i cube = ((p - lowest_) / side_m_).array().floor().cast<int>();
    if ((cube < 0).any() || (cube >= size_).any() || filled[index_of(cube)]) continue;
    filled[index_of(cube)] = true;
    add_ball(cube);
  }
}

void NearPoints::add_ball(const Eigen::Array3i& middle) {
  const auto within = [&](int at, int axis) { return at >= 0 && at < size_[axis]; };
  for (int z = -kCubes; z <= kCubes; ++z)
    for (int y = -kCubes; y <= kCubes; ++y) {
      const int reach = reach_at(y, z);
      if (reach < 0 || !within(middle.y() + y, 1) || !within(middle.z() + z, 2)) continue;
      const int first = std::max(middle.x() - reach, 0);
      const int last = std::min(middle.x() + reach, size_.x() - 1);
      std::uint8_t* row = &near_[index_of(Eigen::Array3i(0, middle.y() + y, middle.z() + z))];
      std::fill(row + first, row + last + 1, std::uint8_t{1});
    }
}

}  // namespace rds::mapper
