// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "common/geometry/box.hpp"

namespace rds::mapper {

/// Box [m] around points without their outliers: per axis, 2nd to 98th percentile. There must be a point.
inline geometry::Box3 trimmed_box(const std::vector<Eigen::Vector3d>& points) {
  constexpr double kTrim = 0.02;
  geometry::Box3 box;
  std::vector<double> values(points.size());
  const auto cut = static_cast<std::size_t>(kTrim * static_cast<double>(values.size()));
  for (int axis = 0; axis < 3; ++axis) {
    std::ranges::transform(points, values.begin(), [&](const auto& p) { return p[axis]; });
    const auto low = values.begin() + static_cast<std::ptrdiff_t>(cut);
    const auto high = values.end() - 1 - static_cast<std::ptrdiff_t>(cut);
    std::ranges::nth_element(values, low);
    box.min[axis] = *low;
    std::ranges::nth_element(low, high, values.end());
    box.max[axis] = *high;
  }
  return box;
}

}  // namespace rds::mapper
