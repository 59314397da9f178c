// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/prediction/observation_filter.hpp"

#include <algorithm>
#include <cmath>

namespace rds::tracker::prediction {
namespace {

constexpr double kMaxCoordinateM = 1e4;
constexpr double kMaxSizeM = 100;

}  // namespace

bool is_usable(const ObjectObservation& observation, double min_score) {
  return geometry::is_valid(observation.box) && std::isfinite(observation.score) &&
         static_cast<double>(observation.score) >= min_score &&
         observation.box.center().cwiseAbs().maxCoeff() <= kMaxCoordinateM &&
         observation.box.size.maxCoeff() <= kMaxSizeM;
}

double overlap_of_smaller(const geometry::OrientedBox& a, const geometry::OrientedBox& b) {
  const Eigen::Vector3d offset = a.map_from_box.linear().transpose() * (b.center() - a.center());
  const Eigen::Array3d smaller = a.size.array().min(b.size.array());
  const Eigen::Array3d shared = ((a.size + b.size).array() / 2 - offset.array().abs()).min(smaller).max(0.0);
  if (shared.z() <= 0) return 0;
  const double area = std::min(a.size.x() * a.size.y(), b.size.x() * b.size.y());
  return std::min(1.0, shared.x() * shared.y() / area);
}

std::vector<ObjectObservation> usable(std::span<const ObjectObservation> observations,
                                      const ObservationLimits& limits) {
  std::vector<ObjectObservation> sorted;
  std::ranges::copy_if(observations, std::back_inserter(sorted),
                       [&](const ObjectObservation& o) { return is_usable(o, limits.min_score); });
  std::ranges::stable_sort(sorted, std::greater<>(), &ObjectObservation::score);
  std::vector<ObjectObservation> kept;
  for (const ObjectObservation& candidate : sorted) {
    if (kept.size() == limits.max_count) break;
    const bool duplicate = std::ranges::any_of(kept, [&](const ObjectObservation& better) {
      return better.label == candidate.label &&
             overlap_of_smaller(better.box, candidate.box) > limits.duplicate_overlap;
    });
    if (!duplicate) kept.push_back(candidate);
  }
  return kept;
}

}  // namespace rds::tracker::prediction
