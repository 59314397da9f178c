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
    const std::size_t at = index_of(((point - lowest_) / side_m_).array().floor().cast<int>());
    return at < near_.size() && near_[at];
  }

 private:
  [[nodiscard]] std::size_t index_of(const Eigen::Array3i& cube) const {
    if ((cube < 0).any() || (cube >= size_).any()) return near_.size();
    return static_cast<std::size_t>((cube.z() * size_.y() + cube.y()) * size_.x() + cube.x());
  }

  float side_m_;
  Eigen::Vector3f lowest_;
  Eigen::Array3i size_;
  std::vector<bool> near_;
};

}  // namespace rds::mapper
