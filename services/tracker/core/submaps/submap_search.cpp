// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/submaps/submap_search.hpp"

#include <algorithm>
#include <map>
#include <vector>

#include "services/tracker/core/loops/loop_drift.hpp"
#include "services/tracker/core/relocalization/place_vote.hpp"
#include "services/tracker/core/relocalization/relief.hpp"
#include "services/tracker/core/submaps/submap_fit.hpp"

namespace rds::tracker {
namespace {

constexpr double kSeesM = 6;  // how far a keyframe's features stand from it
constexpr std::size_t kMinMet = 50;

/// Points of an older submap around the place where the camera was lost.
struct Surroundings {
  VoteWindow window;
  std::vector<PlacedFeature> features;
  std::vector<const MapPoint*> points;  // of the same index
};

/// Where the younger submap's first keyframe may lie in the older one, by how far the camera can have walked.
std::optional<VoteWindow> window_of(const SlamMap& map, SubmapId older, SubmapId younger) {
  const auto border = border_of(map.records(), older, younger);
  if (!border) return std::nullopt;
  const auto reach_m = LoopDrift{.gap_s = border->gap_s}.reach_m();
  if (!reach_m) return std::nullopt;
  return VoteWindow{map.pose_of(border->first).translation(), map.pose_of(border->before).translation(),
                    *reach_m};
}

Surroundings surroundings_of(const SlamMap& map, const VoteWindow& window, SubmapId older, double way_m) {
  Surroundings around{window, {}, {}};
  const double radius_m = window.radius_m + way_m + kSeesM;
  map.points().for_each([&](const MapPoint& p) {
    if (map.records().submaps().of(p.created_by) != older ||
        (p.position - window.point_there).head<2>().norm() > radius_m)
      return;
    around.features.push_back({p.position, &p.descriptor});
    around.points.push_back(&p);
  });
  return around;
}

std::vector<PlacedFeature> placed_features(const Keyframe& keyframe) {
  std::vector<PlacedFeature> placed;
  for (std::size_t i = 0; i < keyframe.features->size(); ++i) {
    const Feature& f = (*keyframe.features)[i];
    if (f.depth_m > 0 && f.matchable && !keyframe.movable[i])
      placed.push_back({keyframe.map_from_camera * keyframe.features->point_in_camera(i), &f.descriptor});
  }
  return placed;
}

/// Of the points by their indices. @return nullptr if no keyframe sees any.
const Keyframe* keyframe_that_sees_most(const SlamMap& map, const Surroundings& around,
                                        const std::vector<std::size_t>& indices) {
  std::map<KeyframeId, int> counts;
  for (const std::size_t i : indices)
    for (const Observation& o : around.points[i]->observations) ++counts[o.keyframe];
  const auto most = std::ranges::max_element(counts, {}, [](const auto& c) { return c.second; });
  return most == counts.end() ? nullptr : map.keyframe(most->first);
}

bool have_relief(const Surroundings& around, const std::vector<std::size_t>& indices,
                 const Eigen::Vector3d& camera) {
  std::vector<Eigen::Vector3d> points;
  for (const std::size_t i : indices) points.push_back(around.features[i].position);
  return relief_of(points, camera) >= kMinRelief;
}

/// @return the place where most is met, of those that are believed.
std::optional<FoundKeyframe> find_in(const SlamMap& map, const Surroundings& around, SubmapId older,
                                     const Keyframe& keyframe) {
  const SubmapId younger = map.records().submaps().of(keyframe.id);
  const auto here = placed_features(keyframe);
  const auto pairs = alike_pairs(here, around.features, around.window);
  if (pairs.size() < kMinMet) return std::nullopt;
  std::optional<FoundKeyframe> best;
  std::vector<Pose> tried;
  for (const VotedPose& voted : vote_for_poses(here, around.features, pairs, around.window)) {
    Pose older_from_younger = voted.there_from_here;
    const auto met = align_alike(here, around.features, pairs, older_from_younger);
    const Pose placed = older_from_younger * keyframe.map_from_camera;
    const bool is_known =
        std::ranges::any_of(tried, [&](const Pose& other) { return are_one(other, placed); });
    tried.push_back(placed);
    const int count = static_cast<int>(met.size());
    if (is_known || met.size() < kMinMet || (best && best->inliers >= count)) continue;
    const Keyframe* seen_from = keyframe_that_sees_most(map, around, met);
    if (seen_from == nullptr || !have_relief(around, met, placed.translation()) ||
        !fits(map, {younger, older, older_from_younger}))
      continue;
    best = FoundKeyframe{
        {keyframe.id, seen_from->id, seen_from->map_from_camera.inverse() * placed}, count, true};
  }
  return best;
}

}  // namespace

std::optional<FoundKeyframe> find_around_loss(const SlamMap& map, KeyframeId id) {
  const Keyframe* keyframe = map.keyframe(id);
  if (keyframe == nullptr) return std::nullopt;
  const SubmapId younger = map.records().submaps().of(id);
  for (SubmapId older = younger; older-- > Submaps::kMap;) {
    const auto window = window_of(map, older, younger);
    if (!window) continue;
    const double way_m = (keyframe->map_from_camera.translation() - window->point_here).norm();
    if (const auto found = find_in(map, surroundings_of(map, *window, older, way_m), older, *keyframe))
      return found;
  }
  return std::nullopt;
}

}  // namespace rds::tracker
