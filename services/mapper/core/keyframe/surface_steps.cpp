// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/keyframe/surface_steps.hpp"

#include <algorithm>
#include <limits>

#include "services/mapper/core/keyframe/keyframe_record.hpp"

namespace rds::mapper {
namespace {

constexpr int kOneMetre = static_cast<int>(kTenthMmPerM);
constexpr int kSlantTenthMm = 300;

}  // namespace

SurfaceSteps::SurfaceSteps(const geometry::DepthNoise& noise) {
  constexpr int kFarthest = std::numeric_limits<std::uint16_t>::max();
  steps_.reserve(kFarthest + 1);
  for (int depth = 0; depth <= kFarthest; ++depth) {
    const int by_slant = depth <= kOneMetre ? kSlantTenthMm : depth / 100 * kSlantTenthMm / 100;
    const float by_noise = noise.difference_m(static_cast<float>(depth) / kTenthMmPerM) * kTenthMmPerM;
    steps_.push_back(
        static_cast<std::uint16_t>(std::min(kFarthest, std::max(by_slant, static_cast<int>(by_noise)))));
  }
}

}  // namespace rds::mapper
