// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/merging/map_merging.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "services/tracker/core/loops/loop_fusion.hpp"
#include "services/tracker/core/mapping/global_adjustment.hpp"
#include "services/tracker/core/merging/common_place.hpp"
#include "services/tracker/core/merging/map_union.hpp"
#include "services/tracker/core/submaps/submap_joining.hpp"

namespace rds::tracker {
namespace {

// Features are found again on a pyramid whose levels are 20 % apart.
constexpr double kMaxFocalDifference = 0.1;
constexpr int kMaxRounds = 5;  // of fusing and adjusting; of maps without drift the second finds nothing new

const Keyframe* first_keyframe(const SlamMap& map) {
  const Keyframe* first = nullptr;
  map.keyframes().for_each([&](const Keyframe& k) {
    if (first == nullptr) first = &k;
  });
  return first;
}

/// Why maps of these cameras do not fit; empty if they do.
std::string other_camera(const geometry::CameraModel& earlier, const geometry::CameraModel& later) {
  const bool fits = earlier.width == later.width && earlier.height == later.height &&
                    std::abs(later.fx / earlier.fx - 1) <= kMaxFocalDifference;
  if (fits) return {};
  return fmt::format(
      "was made with a camera of {}x{} pixels and a focal length of {:.1f} px, expected {}x{} and {:.1f}",
      later.width, later.height, later.fx, earlier.width, earlier.height, earlier.fx);
}

Pose placed_by(const SlamMap& map, const LoopMatch& match) {
  return map.pose_of(match.earlier) * match.earlier_from_later;
}

bool is_in_place(const SlamMap& map, const LoopMatch& match) {
  return are_one(map.pose_of(match.later), placed_by(map, match));
}

void adjust(SlamMap& map, const SavedMap& earlier) {
  LocalMappingJob job = make_global_job(map);
  job.focal_scale = earlier.camera.focal_scale;
  job.given_fx = earlier.camera.given_fx;
  job.pyramid = map.pyramid();
  if (const auto result = run_global_adjustment(job)) apply_global_adjustment(map, *result);
}

/// Fuses what both maps see, and adjusts, until no sighting more agrees. @return the points that were fused.
std::size_t fuse_and_adjust(SlamMap& map, const SavedMap& earlier, Sightings sightings) {
  std::size_t fused = 0;
  for (int round = 0; round < kMaxRounds; ++round) {
    const auto agreeing = std::ranges::stable_partition(
        sightings, [&](const FoundKeyframe& f) { return !is_in_place(map, f.match); });
    if (agreeing.empty()) break;
    for (const FoundKeyframe& f : agreeing)
      if (const auto replaced = join_loop(map, f.match)) fused += replaced->size();
    sightings.erase(agreeing.begin(), agreeing.end());
    adjust(map, earlier);
  }
  return fused;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// What sightings say of the merged map. At least one is in its place.
void measure(const SlamMap& map, const Sightings& found, MapJoint& joint) {
  std::vector<double> off_m;
  std::vector<double> off_rad;
  for (const FoundKeyframe& seen : found) {
    if (!is_in_place(map, seen.match)) continue;
    const Pose off = map.pose_of(seen.match.later).inverse() * placed_by(map, seen.match);
    off_m.push_back(off.translation().norm());
    off_rad.push_back(geometry::rotation_angle_rad(off.linear()));
    joint.inliers += static_cast<std::size_t>(seen.inliers);
  }
  joint.agreeing = off_m.size();
  if (off_m.empty()) return;
  joint.residual_m = median(std::move(off_m));
  joint.residual_rad = median(std::move(off_rad));
}

}  // namespace

tl::expected<MergedMap, std::string> merge_maps(const SavedMap& earlier, const SavedMap& later) {
  const Keyframe* first = first_keyframe(earlier.map);
  const Keyframe* other = first_keyframe(later.map);
  if (first == nullptr || other == nullptr)
    return tl::unexpected<std::string>("one of the two maps has no keyframe");
  if (std::string fault = other_camera(first->features->camera(), other->features->camera()); !fault.empty())
    return tl::unexpected(std::move(fault));
  auto united = unite(earlier.map, later.map);
  if (!united) return tl::unexpected(united.error());
  MergedMap merged{{std::move(*united), earlier.camera}, earlier.map.records().next_id(), {}, {}};
  SlamMap& map = merged.saved.map;
  MapJoint& joint = merged.joint;

  const PoseSettings settings{map.pyramid(), {}};
  const Sightings found = find_later_in_earlier(map, earlier.map, settings, merged.first_of_later);
  joint.searched = later.map.keyframes().size();
  joint.found = found.size();
  const auto chosen = choose_joint(map, found, joint.searched);
  if (!chosen) return tl::unexpected(chosen.error());
  const Pose before = map.pose_of(chosen->later);
  move_submap(map, move_of(map, *chosen));
  joint.fused = fuse_and_adjust(map, earlier, found);
  joint.earlier_from_later = map.pose_of(chosen->later) * before.inverse();
  measure(map, found, joint);
  std::as_const(later.map).keyframes().for_each([&](const Keyframe& k) {
    merged.moved.push_back({k.map_from_camera, map.pose_of(k.id + merged.first_of_later)});
  });
  return merged;
}

}  // namespace rds::tracker
