// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace rds::mapper {

/// The space within a radius of some points, in cubes of a quarter of the radius, which is its accuracy.
class NearPoints {
 public:
  /// @param points  finite, not empty. @param radius_m  above 0.
  NearPoints(const std::vector<Eigen::Vector3f>& points, float radius_m);

  [[nodiscard]] bool contains(const Eigen::Vector3f& point) const {
    Eigen::Array3i cube;
    for (int axis = 0; axis < 3; ++axis) {
      const float at = (point[axis] - lowest_[axis]) / side_m_;
      if (!(at >= 0 && at < static_cast<float>(size_[axis]))) return false;
      cube[axis] = static_cast<int>(at);
    }
    return near_[index_of(cube)] != 0;
  }

 private:
  /// Of a cube inside.
  [[nodiscard]] std::size_t index_of(const Eigen::Array3i& cube) const {
    return static_cast<std::size_t>((cube.z() * size_.y() + cube.y()) * size_.x() + cube.x());
  }
  void add_ball(const Eigen::Array3i& middle);

  float side_m_;
  Eigen::Vector3f lowest_;
  Eigen::Array3i size_;
  std::vector<std::uint8_t> near_;  // 1 in a cube near a point
};

}  // namespace rds::mapper
