// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/submaps/submap_fit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace rds::tracker {
namespace {

constexpr std::size_t kKeyframes = 40;     // of either submap, spread over it
constexpr std::size_t kMeasurements = 80;  // of each, spread over its features
constexpr float kNearPx = 8;               // from a measurement to the features that it is compared with
// Surfaces are slanted and have edges: the depths of two neighbours differ by more than noise. That is within
// these up to 7 m, whatever the camera (docs/decisions/depth-noise.md).
constexpr double kSlackM = 0.15;
constexpr double kSlackShare = 0.1;
// Of a rendered building at the right place .0003, of strips that stand out of a wall .004 … .012; 2.8 m off
// along a corridor .04.
constexpr double kMaxContradicting = 0.02;
// Real depth, and poses that are centimetres off, contradict themselves: keyframes of one submap of 7-Scenes'
// kitchen to .017 … .025, of two submaps at the right place to .027, at the wrong ones of the building to .07
// and more.
constexpr double kMaxAsWithin = 1.5;

using Keyframes = std::vector<const Keyframe*>;

template <class T>
std::vector<T> spread(const std::vector<T>& all, std::size_t most) {
  if (all.size() <= most) return all;
  std::vector<T> chosen;
  for (std::size_t i = 0; i < most; ++i) chosen.push_back(all[i * all.size() / most]);
  return chosen;
}

Keyframes keyframes_of(const SlamMap& map, SubmapId submap) {
  Keyframes all;
  map.keyframes().for_each([&](const Keyframe& k) {
    if (map.records().submaps().of(k.id) == submap) all.push_back(&k);
  });
  return spread(all, kKeyframes);
}

/// What a keyframe measured of what stands still, in its camera's frame.
std::vector<Eigen::Vector3d> measurements_of(const Keyframe& keyframe) {
  std::vector<Eigen::Vector3d> all;
  for (std::size_t i = 0; i < keyframe.features->size(); ++i)
    if ((*keyframe.features)[i].depth_m > 0 && !keyframe.movable[i])
      all.push_back(keyframe.features->point_in_camera(i));
  return spread(all, kMeasurements);
}

double contradicting_share(const SubmapFit& fit) {
  const int compared = fit.agree + fit.contradict;
  return compared > 0 ? static_cast<double>(fit.contradict) / compared : 0;
}

void compare(const Keyframe& view, const Eigen::Vector3d& point_in_view, int levels, SubmapFit& fit) {
  if (point_in_view.z() <= kSlackM) return;
  const Eigen::Vector2d px = view.features->camera().project_undistorted(point_in_view);
  if (!view.features->sees(px)) return;
  bool is_measured = false;
  bool agrees = false;
  bool is_free = true;  // at the edge of what stands before it one of the neighbours is as near
  view.features->for_each_near(px.cast<float>(), kNearPx, 0, levels, [&](std::uint32_t i) {
    const double measured = (*view.features)[i].depth_m;
    if (measured <= 0 || view.movable[i]) return;
    const double farther = measured - point_in_view.z();
    const double slack = kSlackM + kSlackShare * measured;
    is_measured = true;
    agrees = agrees || std::abs(farther) <= slack;
    is_free = is_free && farther > slack;
  });
  fit.agree += agrees ? 1 : 0;
  fit.contradict += is_measured && is_free ? 1 : 0;
}

}  // namespace

SubmapFit fit_of(const SlamMap& map, const SubmapMove& move) {
  SubmapFit fit;
  const Keyframes moved = keyframes_of(map, move.moved);
  const Keyframes still = keyframes_of(map, move.into);
  const int levels = map.pyramid().levels();
  const auto look = [&](const Keyframes& from, const Keyframes& into, const Pose& into_from_from) {
    for (const Keyframe* seen : from) {
      const auto points = measurements_of(*seen);
      for (const Keyframe* view : into) {
        const Pose view_from_seen = view->map_from_camera.inverse() * into_from_from * seen->map_from_camera;
        for (const Eigen::Vector3d& point : points) compare(*view, view_from_seen * point, levels, fit);
      }
    }
  };
  look(moved, still, move.into_from_moved);
  look(still, moved, move.into_from_moved.inverse());
  return fit;
}

bool fits(const SlamMap& map, const SubmapMove& move) {
  const double between = contradicting_share(fit_of(map, move));
  if (between <= kMaxContradicting) return true;
  const auto within = [&](SubmapId submap) {
    return contradicting_share(fit_of(map, {submap, submap, Pose::Identity()}));
  };
  return between <= kMaxAsWithin * std::max(within(move.moved), within(move.into));
}

}  // namespace rds::tracker
