// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace rds::tracker {

/// The share of expected map points that is found. It drops when something enters the picture or covers the
/// lens, and where a pose is wrong.
class FoundShare {
 public:
  /// @param expected, found  map points that should show in the frame, and those that did.
  /// @return the share found relative to its running mean; 1 where too few are expected to tell.
  double update(int expected, int found) {
    const double relative = relative_share(expected, found);
    lowest_ = std::min(lowest_, relative);
    return relative;
  }
  /// The lowest one since begin_interval().
  [[nodiscard]] double lowest() const { return lowest_; }
  void begin_interval() { lowest_ = 1; }

 private:
  static constexpr double kForgetting = 0.1;  // of the running mean
  static constexpr int kMinExpected = 50;     // fewer points say nothing about a change

  double relative_share(int expected, int found) {
    if (expected < kMinExpected) return 1;
    const double share = static_cast<double>(found) / expected;
    const double relative = mean_ > 0 ? share / mean_ : 1;
    mean_ = mean_ > 0 ? mean_ + kForgetting * (share - mean_) : share;
    return relative;
  }

  double mean_ = 0;  // 0: nothing known yet
  double lowest_ = 1;
};

}  // namespace rds::tracker
