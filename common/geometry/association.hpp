// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace rds::geometry {

/// Pairs the elements of two ascending lists of times: nearest pairs first, every element at most once, at
/// most `max_difference` apart (TUM's rule for trajectories and for colour with depth).
///
/// @return index pairs (into a, into b), ascending. Ties go to the earlier a, then the earlier b.
template <class Time>
std::vector<std::pair<std::size_t, std::size_t>> associate(std::span<const Time> a, std::span<const Time> b,
                                                           Time max_difference) {
  std::vector<std::tuple<Time, std::size_t, std::size_t>> candidates;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const auto first = std::ranges::lower_bound(b, a[i] - max_difference);
    const auto last = std::ranges::upper_bound(b, a[i] + max_difference);
    for (auto it = first; it < last; ++it)
      candidates.emplace_back(*it > a[i] ? *it - a[i] : a[i] - *it, i,
                              static_cast<std::size_t>(it - b.begin()));
  }
  std::ranges::sort(candidates);
  std::vector<bool> a_used(a.size());
  std::vector<bool> b_used(b.size());
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const auto& [difference, i, j] : candidates) {
    if (a_used[i] || b_used[j]) continue;
    a_used[i] = b_used[j] = true;
    pairs.emplace_back(i, j);
  }
  std::ranges::sort(pairs);
  return pairs;
}

/// Pairs as many elements of two ascending lists of times as possible, in order, at most `max_difference_ns`
/// apart; of all such pairings the one with the smallest sum of differences.
///
/// For streams that drift against each other: taking the nearest pairs first leaves every seventh picture of
/// such a stretch without a partner although each has one in reach.
///
/// @return index pairs (into a, into b), ascending in both.
std::vector<std::pair<std::size_t, std::size_t>> pair_in_order(std::span<const std::int64_t> a,
                                                               std::span<const std::int64_t> b,
                                                               std::int64_t max_difference_ns);

}  // namespace rds::geometry
