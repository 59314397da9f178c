// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "services/tracker/core/prediction/tracked_object.hpp"

namespace rds::tracker::prediction {

/// How far two boxes of one key frame show the same thing: the area they share, seen along the first box's
/// optical axis, as a share of the smaller one; 0 if they lie behind each other (gap between their depths).
double overlap_of_smaller(const geometry::OrientedBox& a, const geometry::OrientedBox& b);

/// Valid, of at least that score, within 10 km and 100 m size.
bool is_usable(const ObjectObservation& observation, double min_score);

struct ObservationLimits {
  double min_score = 0;
  double duplicate_overlap = 1;
  std::size_t max_count = 0;
};

/// The observations that can be used, best score first, of one label without duplicates (of two that overlap
/// the better one stays).
std::vector<ObjectObservation> usable(std::span<const ObjectObservation> observations,
                                      const ObservationLimits& limits);

}  // namespace rds::tracker::prediction
