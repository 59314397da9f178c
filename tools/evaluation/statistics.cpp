// SPDX-License-Identifier: Apache-2.0
#include "tools/evaluation/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace rds::evaluation {

double percentile(std::span<const double> sample, double percent) {
  if (sample.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::vector<double> sorted(sample.begin(), sample.end());
  std::ranges::sort(sorted);
  const double place = percent / 100 * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  const double share = place - static_cast<double>(below);
  return sorted[below] + share * (sorted[above] - sorted[below]);
}

ErrorStatistics statistics_of(std::span<const double> errors) {
  double sum = 0;
  double squares = 0;
  for (const double e : errors) {
    sum += e;
    squares += e * e;
  }
  const auto n = static_cast<double>(errors.size());
  return {std::sqrt(squares / n), sum / n, percentile(errors, 50), *std::ranges::max_element(errors)};
}

}  // namespace rds::evaluation
