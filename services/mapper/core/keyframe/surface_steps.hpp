// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "common/geometry/depth_noise.hpp"

namespace rds::mapper {

/// By how much the depths of neighbouring sampled pixels of one surface differ at most, in tenths of a
/// millimetre: by noise (difference_m()) or, if that is more, by slant. A surface that is seen at more than
/// 7° changes by less than .03 m × max(1, depth / 1 m) from one sampled pixel to the next (2 px of 525). A
/// table, as each pixel of each keyframe asks.
class SurfaceSteps {
 public:
  explicit SurfaceSteps(const geometry::DepthNoise& noise);

  [[nodiscard]] int at(std::uint16_t depth_tenth_mm) const { return steps_[depth_tenth_mm]; }

 private:
  std::vector<std::uint16_t> steps_;  // by depth
};

}  // namespace rds::mapper
