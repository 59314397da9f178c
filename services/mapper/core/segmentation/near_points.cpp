// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/segmentation/near_points.hpp"

namespace rds::mapper {
namespace {

constexpr int kCubes = 4;  // per radius

/// Cubes of a ball.
std::vector<Eigen::Array3i> ball() {
  std::vector<Eigen::Array3i> offsets;
  for (int z = -kCubes; z <= kCubes; ++z)
    for (int y = -kCubes; y <= kCubes; ++y)
      for (int x = -kCubes; x <= kCubes; ++x)
        if (x * x + y * y + z * z <= kCubes * kCubes) offsets.emplace_back(x, y, z);
  return offsets;
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
  std::vector<bool> filled(static_cast<std::size_t>(size_.prod()), false);
  near_ = filled;
  const auto offsets = ball();
  for (const auto& p : points) {
    const Eigen::Array3i cube = ((p - lowest_) / side_m_).array().floor().cast<int>();
    const std::size_t at = index_of(cube);
    if (at >= filled.size() || filled[at]) continue;
    filled[at] = true;
    for (const auto& offset : offsets)
      if (const std::size_t other = index_of(cube + offset); other < near_.size()) near_[other] = true;
  }
}

}  // namespace rds::mapper
