// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace rds::tracker {

struct RobustLoss {
  double weight;
  double cost;
};

/// Huber's weight and cost for a squared residual; where it is not robust, 1 and the residual itself.
/// @param bound  squared residual from which on the cost grows linearly.
inline RobustLoss robust_loss(double squared, double bound, bool is_robust) {
  if (!is_robust || squared <= bound) return {1, squared};
  const double norm = std::sqrt(squared);
  const double delta = std::sqrt(bound);
  return {delta / norm, 2 * delta * norm - bound};
}

}  // namespace rds::tracker
