// SPDX-License-Identifier: Apache-2.0
#include "services/detector/core/non_maximum_suppression.hpp"

#include <algorithm>

namespace rds::detector {

std::vector<Candidate> suppress_non_maxima(std::vector<Candidate> candidates,
                                           const SuppressionConfig& config) {
  std::ranges::stable_sort(candidates, std::ranges::greater{}, &Candidate::score);
  if (candidates.size() > config.max_candidates) candidates.resize(config.max_candidates);
  std::vector<Candidate> kept;
  for (const Candidate& candidate : candidates) {
    if (kept.size() == config.max_boxes) break;
    const auto covers = [&](const Candidate& better) {
      const bool same = better.label == candidate.label;
      return geometry::iou(better.box, candidate.box) >
             (same ? config.same_label_iou : config.other_label_iou);
    };
    if (std::ranges::none_of(kept, covers)) kept.push_back(candidate);
  }
  return kept;
}

}  // namespace rds::detector
