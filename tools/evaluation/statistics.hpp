// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

namespace rds::evaluation {

/// Value below which `percent` of the sample lies, linear between neighbours (numpy's default).
///
/// @return NaN for an empty sample.
double percentile(std::span<const double> sample, double percent);

struct ErrorStatistics {
  double rmse = 0;
  double mean = 0;
  double median = 0;
  double max = 0;
};

/// @param errors  ≥ 0, at least one.
ErrorStatistics statistics_of(std::span<const double> errors);

}  // namespace rds::evaluation
