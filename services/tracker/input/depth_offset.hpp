// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <deque>

namespace rds::tracker {

/// By how much the stamps of depth pictures are later than those of their colour pictures: 0, until colour
/// pictures find no partner although depth is always as late (a driver that stamps depth when it has been
/// computed, a camera whose two sensors do not wait for each other).
///
/// Learned from the gaps between kWindow colour pictures and the depth pictures nearest to them, where a
/// quarter of those have no partner, and all gaps are alike to kAlike: their median. So it is half a period
/// at most. Depends on the stamps alone.
class DepthOffset {
 public:
  static constexpr std::size_t kWindow = 20;               // two thirds of a second to two seconds
  static constexpr std::int64_t kAlike_ns = 10'000'000;    // stamps of one driver
  static constexpr std::int64_t kLargest_ns = 50'000'000;  // half a period at 10 Hz; beyond, clocks differ

  /// @param gap_ns  from a colour picture to the depth picture nearest to it. @param is_pair  they are a
  /// pair.
  void take(std::int64_t gap_ns, bool is_pair) {
    if (std::abs(gap_ns) > kLargest_ns) return gaps_.clear();
    gaps_.push_back({gap_ns, is_pair});
    if (gaps_.size() > kWindow) gaps_.pop_front();
    const auto alone = std::ranges::count(gaps_, false, &Gap::is_pair);
    if (gaps_.size() < kWindow || 4 * static_cast<std::size_t>(alone) < kWindow) return;
    auto sorted = gaps_;
    std::ranges::sort(sorted, {}, &Gap::ns);
    if (sorted.back().ns - sorted.front().ns > kAlike_ns) return;
    ns_ = sorted[kWindow / 2].ns;
    gaps_.clear();
  }

  [[nodiscard]] std::int64_t ns() const { return ns_; }

 private:
  struct Gap {
    std::int64_t ns;
    bool is_pair;
  };
  std::deque<Gap> gaps_;
  std::int64_t ns_ = 0;
};

}  // namespace rds::tracker
