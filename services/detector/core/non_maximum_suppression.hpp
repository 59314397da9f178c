// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "services/detector/core/decoder.hpp"

namespace rds::detector {

struct SuppressionConfig {
  double same_label_iou = 0.45;      // a box that overlaps a better one of its label by more is dropped
  double other_label_iou = 1.0;      // the same across labels; 1 keeps both
  std::size_t max_candidates = 400;  // only the best are looked at
  std::size_t max_boxes = 100;       // and so many kept

  bool operator==(const SuppressionConfig&) const = default;
};

/// Greedy non-maximum suppression. Boxes of equal score keep the order of their input.
///
/// @return the survivors, best score first.
std::vector<Candidate> suppress_non_maxima(std::vector<Candidate> candidates,
                                           const SuppressionConfig& config);

}  // namespace rds::detector
