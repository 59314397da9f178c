// SPDX-License-Identifier: Apache-2.0
#include "services/loop_closer/core/loop_verification.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <Eigen/Eigenvalues>

#include "common/vision/descriptor_matching.hpp"
#include "services/loop_closer/core/point_registration.hpp"

namespace rds::loop_closer {
namespace {

using geometry::Pose;

// Descriptors of two different points would differ in 128 ± 8 of 256 bits if bits were independent: 64 are
// eight standard deviations fewer. The ratio is wider than Lowe's .8, since RANSAC follows.
constexpr vision::DescriptorMatchConfig kMatching{.max_distance = 64, .max_ratio = 0.85};

constexpr double kGuidedDepthGates = 2.0;  // inverse-depth gates that a guided match may be off
constexpr double kSearchRadius = 0.02;     // in x/z and y/z, of a guided match; 2.5 times kMaxRayError
constexpr int kMinInliers = 50;
constexpr double kMinInlierShare = 0.2;  // of what both keyframes should see; one poster in two rooms has less
constexpr double kMinExtentM = 0.15;     // second largest standard deviation of the matched points

Eigen::Vector2d ray(const Eigen::Vector3d& point) {
  return point.head<2>() / point.z();
}

/// Features of a view by the cell of their ray.
class RayGrid {
 public:
  RayGrid(const KeyframeView& view, double cell) : cell_(cell) {
    for (std::size_t i = 0; i < view.points.size(); ++i)
      features_[cell_of(ray(view.points[i]))].push_back(static_cast<int>(i));
  }

  /// Calls visit(feature) for the features in the cell of `at` and around it.
  template <class Visit>
  void around(const Eigen::Vector2d& at, Visit&& visit) const {
    const auto [x, y] = cell_of(at);
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        if (const auto found = features_.find({x + dx, y + dy}); found != features_.end())
          for (const int feature : found->second) visit(feature);
  }

 private:
  [[nodiscard]] std::pair<int, int> cell_of(const Eigen::Vector2d& at) const {
    const Eigen::Vector2d cell = (at / cell_).array().floor().cwiseMax(-1e6).cwiseMin(1e6);
    return {static_cast<int>(cell.x()), static_cast<int>(cell.y())};
  }

  double cell_;
  std::map<std::pair<int, int>, std::vector<int>> features_;
};

std::vector<PointPair> pairs_of(const KeyframeView& query, const KeyframeView& candidate,
                                const std::vector<vision::DescriptorMatch>& matches) {
  std::vector<PointPair> pairs;
  pairs.reserve(matches.size());
  for (const auto& match : matches)
    pairs.push_back({query.points[static_cast<std::size_t>(match.query)],
                     candidate.points[static_cast<std::size_t>(match.train)]});
  return pairs;
}

/// The candidate's feature most like the query's among those near where the transform puts it; train −1 if
/// none.
vision::DescriptorMatch guided_match(const KeyframeView& query, int row,
                                     const Eigen::Vector3d& point_in_candidate, const KeyframeView& candidate,
                                     const RayGrid& grid) {
  vision::DescriptorMatch best{row, -1, kMatching.max_distance + 1};
  const Eigen::Vector2d expected = ray(point_in_candidate);
  grid.around(expected, [&](int feature) {
    const Eigen::Vector3d& point = candidate.points[static_cast<std::size_t>(feature)];
    if ((ray(point) - expected).norm() > kSearchRadius) return;
    if (std::abs(1 / point.z() - 1 / point_in_candidate.z()) > kGuidedDepthGates * kMaxInverseDepthError)
      return;
    const int distance = vision::hamming_distance(query.descriptors.ptr<std::uint8_t>(row),
                                                  candidate.descriptors.ptr<std::uint8_t>(feature));
    if (distance < best.distance) best = {row, feature, distance};
  });
  return best;
}

/// Matches near where the transform puts them; no candidate feature twice.
std::vector<vision::DescriptorMatch> guided_matches(const KeyframeView& query, const KeyframeView& candidate,
                                                    const Pose& candidate_from_query) {
  const RayGrid grid(candidate, kSearchRadius);
  std::vector<vision::DescriptorMatch> best_of(candidate.points.size(), {-1, -1, kMatching.max_distance + 1});
  for (std::size_t i = 0; i < query.points.size(); ++i) {
    const Eigen::Vector3d point = candidate_from_query * query.points[i];
    if (point.z() <= 0.05) continue;
    const auto match = guided_match(query, static_cast<int>(i), point, candidate, grid);
    if (match.train < 0) continue;
    auto& best = best_of[static_cast<std::size_t>(match.train)];
    if (match.distance < best.distance) best = match;
  }
  std::erase_if(best_of, [](const auto& match) { return match.train < 0; });
  return best_of;
}

/// Features of `view` that a camera with the rays of `other` should see from where it stands.
int visible_features(const KeyframeView& view, const Pose& other_from_view, const KeyframeView& other) {
  Eigen::Array2d lowest = Eigen::Array2d::Constant(1e9);
  Eigen::Array2d highest = -lowest;
  for (const auto& point : other.points) {
    lowest = lowest.min(ray(point).array());
    highest = highest.max(ray(point).array());
  }
  return static_cast<int>(
      std::count_if(view.points.begin(), view.points.end(), [&](const Eigen::Vector3d& point) {
        const Eigen::Vector3d seen = other_from_view * point;
        return seen.z() > 0.05 && (ray(seen).array() >= lowest).all() && (ray(seen).array() <= highest).all();
      }));
}

/// Second largest standard deviation [m]: small if the points lie in one spot or on one line.
double extent(std::span<const PointPair> pairs, const std::vector<int>& inliers) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const int i : inliers) mean += pairs[static_cast<std::size_t>(i)].in_query;
  mean /= static_cast<double>(inliers.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const int i : inliers) {
    const Eigen::Vector3d d = pairs[static_cast<std::size_t>(i)].in_query - mean;
    covariance += d * d.transpose() / static_cast<double>(inliers.size());
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues()[1]));
}

}  // namespace

std::optional<VerifiedLoop> verify_loop(const KeyframeView& query, const KeyframeView& candidate) {
  const auto matches = vision::match_descriptors(query.descriptors, candidate.descriptors, kMatching);
  const auto first = register_points(pairs_of(query, candidate, matches));
  if (!first) return std::nullopt;
  const auto guided = guided_matches(query, candidate, first->candidate_from_query);
  const auto pairs = pairs_of(query, candidate, guided);
  const Registration refined = refine_registration(pairs, first->candidate_from_query);
  const int inliers = static_cast<int>(refined.inliers.size());
  if (inliers < kMinInliers || extent(pairs, refined.inliers) < kMinExtentM) return std::nullopt;
  const Pose& pose = refined.candidate_from_query;
  const int visible =
      std::min(visible_features(query, pose, candidate), visible_features(candidate, pose.inverse(), query));
  const double share = inliers / std::max(1.0, static_cast<double>(visible));
  if (share < kMinInlierShare) return std::nullopt;
  return VerifiedLoop{pose, inliers, share};
}

}  // namespace rds::loop_closer
