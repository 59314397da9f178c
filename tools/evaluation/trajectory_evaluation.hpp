// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "common/geometry/trajectory.hpp"
#include "tools/evaluation/statistics.hpp"

namespace rds::evaluation {

/// By what an estimate is laid on the truth.
enum class Alignment {
  kPositions,     // as ATE asks
  kOrientations,  // where the camera hardly leaves its place: align_orientations()
};

struct TrajectoryEvaluationOptions {
  double max_difference_s = 0.02;  // poses further apart in time are no pair
  double rpe_interval_s = 1.0;
  Alignment align = Alignment::kPositions;
};

struct RelativeErrors {
  std::size_t count = 0;
  ErrorStatistics translation_m;
  ErrorStatistics rotation_deg;
};

/// Error of an estimated trajectory against the truth.
struct TrajectoryErrors {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;  // indices into truth, estimate
  ErrorStatistics absolute_m;                              // after one rigid alignment: ATE
  std::vector<double> error_m;                             // of each pair
  geometry::Pose truth_from_estimate = geometry::Pose::Identity();
  double similarity_scale = 1;  // reported, never applied
  double span_s = 0;            // from the first to the last pair
  double path_m = 0;            // length of the true path through the pairs
  std::optional<RelativeErrors> relative;
};

/// Absolute and relative trajectory error (Sturm et al., IROS 2012, §V), SE(3) alignment without scale.
///
/// The relative error spans, for each pair, to the pair nearest to `rpe_interval_s` later (at most a tenth of
/// it and 20 ms off). @return nullopt with fewer than three pairs.
std::optional<TrajectoryErrors> evaluate_trajectory(std::span<const geometry::StampedPose> truth,
                                                    std::span<const geometry::StampedPose> estimate,
                                                    const TrajectoryEvaluationOptions& options = {});

}  // namespace rds::evaluation
