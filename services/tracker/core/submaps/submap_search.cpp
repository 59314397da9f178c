// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/submaps/submap_search.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <vector>

#include "services/tracker/core/loops/loop_drift.hpp"
#include "services/tracker/core/submaps/submap_fit.hpp"
#include "services/tracker/core/relocalization/place_vote.hpp"
#include "services/tracker/core/relocalization/relief.hpp"

namespace rds::tracker {
namespace {

constexpr double kNsPerSecond = 1e9;
constexpr double kMaxGapS = 5;
constexpr double kBesideM = 1;  // of one who stands and turns
constexpr double kWalkingMPerS = 1.5;
constexpr double kSeesM = 6;  // how far a keyframe's features stand from it
constexpr std::size_t kMinMet = 50;

/// Points of an older submap around the place where the camera was lost.
struct Surroundings {
  VoteWindow window;
  std::vector<PlacedFeature> features;
  std::vector<const MapPoint*> points;  // of the same index
};

/// Where the younger submap's first keyframe may lie in the older one.
std::optional<VoteWindow> window_of(const SlamMap& map, SubmapId older, SubmapId younger) {
  const KeyframeRecords& records = map.records();
  const auto border = border_of(records, older, younger);
  if (!border) return std::nullopt;
  const std::int64_t gap_ns = records[border->first].stamp_ns - records[border->before].stamp_ns;
  const double gap_s = static_cast<double>(gap_ns) / kNsPerSecond;
  if (gap_s < 0 || gap_s > kMaxGapS) return std::nullopt;
  return VoteWindow{map.pose_of(border->first).translation(), map.pose_of(border->before).translation(),
                    kBesideM + kWalkingMPerS * gap_s};
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

std::optional<FoundKeyframe> find_in(const SlamMap& map, const Surroundings& around, SubmapId older,
                                     const Keyframe& keyframe) {
  const auto here = placed_features(keyframe);
  const auto pairs = alike_pairs(here, around.features, around.window);
  if (pairs.size() < kMinMet) return std::nullopt;
  std::optional<FoundKeyframe> best;
  std::vector<Pose> tried;
  for (const VotedPose& voted : vote_for_poses(here, around.features, pairs, around.window)) {
    Pose older_from_younger = voted.there_from_here;
    const auto met = align_alike(here, around.features, pairs, older_from_younger);
    const int count = static_cast<int>(met.size());
    const Pose older_from_camera = older_from_younger * keyframe.map_from_camera;
    const auto is_same = [&](const Pose& other) { return are_one(other, older_from_camera); };
    if (met.size() < kMinMet || (best && best->inliers >= count) || std::ranges::any_of(tried, is_same) ||
        !have_relief(around, met, older_from_camera.translation()))
      continue;
    tried.push_back(older_from_camera);
    const Keyframe* seen_from = keyframe_that_sees_most(map, around, met);
    const SubmapId younger = map.records().submaps().of(keyframe.id);
    if (seen_from != nullptr && fits(map, {younger, older, older_from_younger}))
      best = FoundKeyframe{{keyframe.id, seen_from->id, seen_from->map_from_camera.inverse() * older_from_camera},
                           count,
                           true};
  }
  return best;
}

/// The older submaps, each once, the youngest first.
std::set<SubmapId, std::greater<>> older_than(const Submaps& submaps, SubmapId younger) {
  std::set<SubmapId, std::greater<>> older;
  if (younger > Submaps::kMap) older.insert(Submaps::kMap);
  for (const auto& [first, submap] : submaps.rows())
    if (submap < younger) older.insert(submap);
  return older;
}

}  // namespace

std::optional<FoundKeyframe> find_around_loss(const SlamMap& map, KeyframeId id) {
  const Keyframe* keyframe = map.keyframe(id);
  if (keyframe == nullptr) return std::nullopt;
  const Submaps& submaps = map.records().submaps();
  for (const SubmapId older : older_than(submaps, submaps.of(id))) {
    const auto window = window_of(map, older, submaps.of(id));
    if (!window) continue;
    const double way_m = (keyframe->map_from_camera.translation() - window->point_here).norm();
    if (const auto found = find_in(map, surroundings_of(map, *window, older, way_m), older, *keyframe))
      return found;
  }
  return std::nullopt;
}

}  // namespace rds::tracker
