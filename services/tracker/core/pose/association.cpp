// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/pose/association.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "services/tracker/core/pose/pose_optimization.hpp"

namespace rds::tracker {
namespace {

constexpr double kMinViewCosine = 0.5;      // 60° from the mean viewing direction
constexpr double kInLineOfSight = 0.998;    // cosine
constexpr double kDistanceTolerance = 1.2;  // beyond the range of levels
constexpr double kStraightWindowPx = 2.5;
constexpr double kObliqueWindowPx = 4;
constexpr int kFar = 257;                 // more than descriptors can differ
constexpr double kMaxRatio = 0.8;         // of the best to the second best distance at one level
constexpr double kStaticAfterNs = 0.4e9;  // over which a point was found in its place: it is static
constexpr double kMinWeight = 0.02;       // of a point that may move

/// Removes the matches whose feature turned otherwise than most did.
void keep_consistent_rotation(std::span<const std::uint32_t> matched, std::span<const float> differences,
                              TrackedFrame& frame) {
  const auto keep = consistent_rotation(differences);
  for (std::size_t i = 0; i < matched.size(); ++i)
    if (!keep[i]) frame.points[matched[i]] = kNoId;
}

/// The two features whose descriptors are nearest.
struct Neighbours {
  std::uint32_t nearest = 0;
  int distance = kFar;
  int level = -1;
  int second_distance = kFar;
  int second_level = -1;

  void offer(std::uint32_t candidate, int candidate_distance, int candidate_level) {
    if (candidate_distance < distance) {
      second_distance = distance;
      second_level = level;
      distance = candidate_distance;
      level = candidate_level;
      nearest = candidate;
    } else if (candidate_distance < second_distance) {
      second_distance = candidate_distance;
      second_level = candidate_level;
    }
  }
};

}  // namespace

std::optional<std::uint32_t> best_in_window(const FeatureSet& features, std::span<const PointId> taken,
                                            const ObservationModel& model, const Descriptor& descriptor,
                                            const SearchWindow& window, int max_distance, double ratio) {
  Neighbours found;
  features.for_each_near(
      window.px, window.radius_px, window.min_level, window.max_level, [&](std::uint32_t i) {
        if (!taken.empty() && taken[i] != kNoId) return;
        const Feature& f = features[i];
        if (f.depth_m > 0 && window.disparity_px > 0 &&
            std::abs(model.disparity(static_cast<double>(f.depth_m)) - window.disparity_px) >
                static_cast<double>(window.radius_px))
          return;
        found.offer(i, descriptor_distance(descriptor, f.descriptor), f.level);
      });
  if (found.distance > max_distance) return std::nullopt;
  if (found.level == found.second_level && found.distance > ratio * found.second_distance)
    return std::nullopt;
  return found.nearest;
}

std::vector<bool> consistent_rotation(std::span<const float> differences) {
  constexpr int kBins = 30;
  constexpr double kMinShareOfFullest = 0.1;
  constexpr auto kTurn = 2 * std::numbers::pi;
  std::vector<int> bin(differences.size());
  std::array<int, kBins> count{};
  for (std::size_t i = 0; i < differences.size(); ++i) {
    const double turn = static_cast<double>(differences[i]) / kTurn;
    bin[i] = static_cast<int>(std::lround((turn - std::floor(turn)) * kBins)) % kBins;
    ++count[static_cast<std::size_t>(bin[i])];
  }
  std::array<int, kBins> fullest{};
  for (int b = 0; b < kBins; ++b) fullest[static_cast<std::size_t>(b)] = b;
  std::ranges::stable_sort(fullest, std::ranges::greater{},
                           [&](int b) { return count[static_cast<std::size_t>(b)]; });
  std::array<bool, kBins> good{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto b = static_cast<std::size_t>(fullest[k]);
    good[b] = count[b] >= kMinShareOfFullest * count[static_cast<std::size_t>(fullest[0])];
  }
  std::vector<bool> keep(differences.size());
  for (std::size_t i = 0; i < bin.size(); ++i) keep[i] = good[static_cast<std::size_t>(bin[i])];
  return keep;
}

std::optional<ProjectedPoint> project_point(const MapPoint& point, const Pose& camera_from_map,
                                            const Eigen::Vector3d& camera_in_map, const FeatureSet& view,
                                            const ObservationModel& model, const ScalePyramid& pyramid) {
  const Eigen::Vector3d p = camera_from_map * point.position;
  if (p.z() < kMinDepth) return std::nullopt;
  ProjectedPoint projected;
  projected.px = model.project(p);
  if (!view.sees(projected.px)) return std::nullopt;
  const Eigen::Vector3d ray = point.position - camera_in_map;
  projected.depth = p.z();
  projected.distance = ray.norm();
  if (projected.distance > kDistanceTolerance * point.level_0_distance ||
      projected.distance * kDistanceTolerance * pyramid.largest() < point.level_0_distance)
    return std::nullopt;
  projected.view_cosine = ray.dot(point.normal) / projected.distance;
  if (projected.view_cosine < kMinViewCosine) return std::nullopt;
  projected.level = pyramid.predict(point.level_0_distance, projected.distance);
  return projected;
}

int match_last_frame(const SlamMap& map, const TrackedFrame& last, const ObservationModel& model,
                     const ScalePyramid& pyramid, double window_px, TrackedFrame& frame) {
  frame.clear_matches();
  std::vector<std::uint32_t> matched;
  std::vector<float> differences;
  for (std::size_t i = 0; i < last.points.size(); ++i) {
    if (last.points[i] == kNoId) continue;
    const MapPoint* point = map.point(last.points[i]);
    if (point == nullptr) continue;
    const Eigen::Vector3d p = frame.camera_from_map * point->position;
    if (p.z() < kMinDepth) continue;
    const Eigen::Vector2d px = model.project(p);
    if (!frame.features->sees(px)) continue;
    const Feature& before = (*last.features)[i];
    const SearchWindow window{px.cast<float>(), static_cast<float>(window_px * pyramid.scale(before.level)),
                              before.level - 1, before.level + 1, model.disparity(p.z())};
    const auto found = best_in_window(*frame.features, frame.points, model, before.descriptor, window,
                                      kMaxDistanceNearby, 1);
    if (!found) continue;
    frame.points[*found] = point->id;
    matched.push_back(*found);
    differences.push_back(before.angle_rad - (*frame.features)[*found].angle_rad);
  }
  keep_consistent_rotation(matched, differences, frame);
  return frame.matches();
}

int match_keyframe(const SlamMap& map, const Keyframe& keyframe, TrackedFrame& frame) {
  frame.clear_matches();
  const std::size_t n = frame.features->size();
  std::vector<Neighbours> of_feature(n);  // nearest keyframe feature of each frame feature
  std::vector<std::pair<std::uint32_t, Neighbours>> of_point;
  for (std::uint32_t k = 0; k < keyframe.points.size(); ++k) {
    if (map.point(keyframe.points[k]) == nullptr) continue;
    const Descriptor& descriptor = (*keyframe.features)[k].descriptor;
    Neighbours found;
    for (std::uint32_t i = 0; i < n; ++i) {
      if ((*frame.features)[i].movable) continue;
      const int distance = descriptor_distance(descriptor, (*frame.features)[i].descriptor);
      found.offer(i, distance, 0);
      of_feature[i].offer(k, distance, 0);
    }
    of_point.emplace_back(k, found);
  }
  std::vector<std::uint32_t> matched;
  std::vector<float> differences;
  for (const auto& [k, found] : of_point) {
    if (found.distance > kMaxDistanceAlone || of_feature[found.nearest].nearest != k) continue;
    if (found.distance > kMaxRatio * found.second_distance) continue;
    frame.points[found.nearest] = keyframe.points[k];
    matched.push_back(found.nearest);
    differences.push_back((*keyframe.features)[k].angle_rad - (*frame.features)[found.nearest].angle_rad);
  }
  keep_consistent_rotation(matched, differences, frame);
  return frame.matches();
}

PointMatches match_points(SlamMap& map, std::span<const PointId> points, const ObservationModel& model,
                          const ScalePyramid& pyramid, double window_factor, TrackedFrame& frame) {
  const Eigen::Vector3d camera_in_map = frame.camera_from_map.inverse().translation();
  PointMatches matches;
  for (const PointId id : points) {
    MapPoint* point = map.point(id);
    if (point == nullptr) continue;
    const auto projected =
        project_point(*point, frame.camera_from_map, camera_in_map, *frame.features, model, pyramid);
    if (!projected) continue;
    ++point->visible;
    ++matches.expected;
    const double window = projected->view_cosine > kInLineOfSight ? kStraightWindowPx : kObliqueWindowPx;
    const SearchWindow where{projected->px.cast<float>(),
                             static_cast<float>(window * window_factor * pyramid.scale(projected->level)),
                             projected->level - 1, projected->level + 1, model.disparity(projected->depth)};
    const auto found = best_in_window(*frame.features, frame.points, model, point->descriptor, where,
                                      kMaxDistanceNearby, kMaxRatio);
    if (!found) continue;
    frame.points[*found] = id;
    ++matches.found;
  }
  return matches;
}

double static_weight(const SlamMap& map, const MapPoint& point) {
  if (point.observations.empty() || 2 * point.found < point.visible) return kMinWeight;
  const std::int64_t first_ns = map.keyframe(point.observations.front().keyframe)->time_ns;
  const std::int64_t last_ns = map.keyframe(point.observations.back().keyframe)->time_ns;
  const auto seen_ns = static_cast<double>(std::max(last_ns, point.last_found_ns) - first_ns);
  return std::clamp(std::pow(seen_ns / kStaticAfterNs, 2), kMinWeight, 1.0);
}

int optimize_frame(const SlamMap& map, const ObservationModel& model, const ScalePyramid& pyramid,
                   TrackedFrame& frame) {
  std::vector<PointObservation> observations;
  std::vector<std::size_t> feature;
  for (std::size_t i = 0; i < frame.points.size(); ++i) {
    if (frame.points[i] == kNoId) continue;
    const MapPoint* point = map.point(frame.points[i]);
    if (point == nullptr) {
      frame.points[i] = kNoId;
      continue;
    }
    observations.push_back({point->position, model.measurement((*frame.features)[i], pyramid),
                            frame.movable_in_view ? static_weight(map, *point) : 1});
    feature.push_back(i);
  }
  const OptimizedPose optimized = frame.pose_is_given
                                      ? check_pose(model, observations, frame.camera_from_map)
                                      : optimize_pose(model, observations, frame.camera_from_map);
  frame.camera_from_map = optimized.camera_from_map;
  frame.information = optimized.information;
  for (std::size_t i = 0; i < feature.size(); ++i)
    if (!optimized.inlier[i]) frame.points[feature[i]] = kNoId;
  return optimized.inliers;
}

}  // namespace rds::tracker
