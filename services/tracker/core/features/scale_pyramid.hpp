// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <vector>

namespace rds::tracker {

/// Scale factors of the feature pyramid: level l is 1 / scale(l) of the picture's size.
class ScalePyramid {
 public:
  ScalePyramid(int levels, double factor) : log_factor_(std::log(factor)) {
    for (int l = 0; l < levels; ++l) scales_.push_back(std::pow(factor, l));
  }

  [[nodiscard]] int levels() const { return static_cast<int>(scales_.size()); }
  [[nodiscard]] double scale(int level) const { return scales_[static_cast<std::size_t>(level)]; }
  [[nodiscard]] double largest() const { return scales_.back(); }

  /// Level at which a point shows at `distance` that would show at level 0 from `distance_at_level_0`.
  [[nodiscard]] int predict(double distance_at_level_0, double distance) const {
    const int level = static_cast<int>(std::ceil(std::log(distance_at_level_0 / distance) / log_factor_));
    return level < 0 ? 0 : level >= levels() ? levels() - 1 : level;
  }

 private:
  std::vector<double> scales_;
  double log_factor_;
};

}  // namespace rds::tracker
