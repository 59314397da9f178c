// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

#include <Eigen/Core>

namespace rds::tracker {

using Descriptor = std::array<std::uint8_t, 32>;

/// One ORB feature of a picture.
struct Feature {
  Eigen::Vector2f px = Eigen::Vector2f::Zero();        // undistorted
  Eigen::Vector2f image_px = Eigen::Vector2f::Zero();  // where it stands in the picture
  float angle_rad = 0;                                 // 0 … 2π, from x towards y
  float depth_m = 0;                                   // 0 without measurement
  std::uint8_t level = 0;                              // of the pyramid
  bool movable = false;                                // on a movable object: never becomes a map point
  bool matchable = true;  // false: for pictures only, without angle and descriptor
  Descriptor descriptor{};
};

/// Number of differing bits, 0 … 256.
inline int descriptor_distance(const Descriptor& a, const Descriptor& b) {
  int distance = 0;
  for (std::size_t i = 0; i < a.size(); i += sizeof(std::uint64_t)) {
    std::uint64_t x = 0;
    std::uint64_t y = 0;
    std::memcpy(&x, a.data() + i, sizeof(x));
    std::memcpy(&y, b.data() + i, sizeof(y));
    distance += std::popcount(x ^ y);
  }
  return distance;
}

}  // namespace rds::tracker
