// SPDX-License-Identifier: Apache-2.0
#include "tools/evaluation/trajectory_evaluation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/geometry/alignment.hpp"
#include "common/geometry/association.hpp"
#include "common/geometry/stamp.hpp"

namespace rds::evaluation {
namespace {
using geometry::Pose;
using geometry::StampedPose;

constexpr std::size_t kFewestPairs = 3;
constexpr double kIntervalSlackShare = 0.1;
constexpr double kIntervalSlackS = 0.02;

std::vector<double> seconds_of(std::span<const StampedPose> poses) {
  std::vector<double> seconds;
  seconds.reserve(poses.size());
  for (const auto& pose : poses) seconds.push_back(geometry::stamp_seconds(pose.stamp_ns));
  return seconds;
}

/// The two trajectories at the paired instants.
struct Matched {
  std::vector<Pose> truth;
  std::vector<Pose> estimate;
  std::vector<double> time_s;  // of the estimate
};

/// Index of the pair nearest to `interval` after pair i; nullopt if none is near enough.
std::optional<std::size_t> pair_after(const std::vector<double>& time_s, std::size_t i, double interval) {
  const auto off = [&](std::size_t k) { return std::abs(time_s[k] - time_s[i] - interval); };
  auto j = static_cast<std::size_t>(std::ranges::lower_bound(time_s, time_s[i] + interval) - time_s.begin());
  if (j > 0 && j < time_s.size() && off(j - 1) < off(j)) --j;
  if (j <= i || j >= time_s.size() || off(j) > kIntervalSlackShare * interval + kIntervalSlackS)
    return std::nullopt;
  return j;
}

double rotation_deg(const Eigen::Matrix3d& rotation) {
  return std::acos(std::clamp((rotation.trace() - 1) / 2, -1.0, 1.0)) * 180 / std::numbers::pi;
}

std::optional<RelativeErrors> relative_errors(const Matched& matched, double interval) {
  std::vector<double> translation;
  std::vector<double> rotation;
  for (std::size_t i = 0; i < matched.truth.size(); ++i) {
    const auto j = pair_after(matched.time_s, i, interval);
    if (!j) continue;
    const Pose true_motion = matched.truth[i].inverse() * matched.truth[*j];
    const Pose error = true_motion.inverse() * (matched.estimate[i].inverse() * matched.estimate[*j]);
    translation.push_back(error.translation().norm());
    rotation.push_back(rotation_deg(error.linear()));
  }
  if (translation.empty()) return std::nullopt;
  return RelativeErrors{translation.size(), statistics_of(translation), statistics_of(rotation)};
}

double path_length(std::span<const Eigen::Vector3d> points) {
  double length = 0;
  for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
  return length;
}

}  // namespace

std::optional<TrajectoryErrors> evaluate_trajectory(std::span<const StampedPose> truth,
                                                    std::span<const StampedPose> estimate,
                                                    const TrajectoryEvaluationOptions& options) {
  const auto truth_s = seconds_of(truth);
  const auto estimate_s = seconds_of(estimate);
  TrajectoryErrors result;
  result.pairs = geometry::associate<double>(truth_s, estimate_s, options.max_difference_s);
  if (result.pairs.size() < kFewestPairs) return std::nullopt;

  Matched matched;
  std::vector<Eigen::Vector3d> truth_points;
  std::vector<Eigen::Vector3d> points;
  for (const auto& [i, j] : result.pairs) {
    matched.truth.push_back(truth[i].map_from_camera);
    matched.estimate.push_back(estimate[j].map_from_camera);
    matched.time_s.push_back(estimate_s[j]);
    truth_points.emplace_back(truth[i].map_from_camera.translation());
    points.emplace_back(estimate[j].map_from_camera.translation());
  }
  const auto alignment = geometry::align_rigid(points, truth_points);
  result.truth_from_estimate = options.align == Alignment::kOrientations
                                   ? geometry::align_orientations(matched.estimate, matched.truth)
                                   : alignment.target_from_source;
  result.similarity_scale = alignment.similarity_scale;
  for (std::size_t k = 0; k < points.size(); ++k)
    result.error_m.push_back((result.truth_from_estimate * points[k] - truth_points[k]).norm());
  result.absolute_m = statistics_of(result.error_m);
  result.span_s = truth_s[result.pairs.back().first] - truth_s[result.pairs.front().first];
  result.path_m = path_length(truth_points);
  result.relative = relative_errors(matched, options.rpe_interval_s);
  return result;
}

}  // namespace rds::evaluation
