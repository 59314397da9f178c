// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/map/covisibility.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace rds::tracker {
namespace {

constexpr int kMinWeight = 15;  // shared points that make an edge

void set_covisible(Keyframe& keyframe, KeyframeId other, int weight) {
  std::erase_if(keyframe.covisible, [other](const CovisibleKeyframe& c) { return c.id == other; });
  if (weight <= 0) return;
  const auto place = std::ranges::find_if(keyframe.covisible, [&](const CovisibleKeyframe& c) {
    return c.weight < weight || (c.weight == weight && c.id > other);
  });
  keyframe.covisible.insert(place, {other, weight});
}

}  // namespace

void remove_covisibility(SlamMap& map, const Keyframe& keyframe) {
  for (const CovisibleKeyframe& c : keyframe.covisible)
    if (Keyframe* other = map.keyframe(c.id)) set_covisible(*other, keyframe.id, 0);
}

void update_covisibility(SlamMap& map, KeyframeId id) {
  Keyframe* keyframe = map.keyframe(id);
  if (keyframe == nullptr) return;
  std::map<KeyframeId, int> shared;
  for (const PointId p : keyframe->points)
    if (const MapPoint* point = map.point(p))
      for (const Observation& o : point->observations)
        if (o.keyframe != id) ++shared[o.keyframe];
  CovisibleKeyframe strongest;
  for (const auto& [other, weight] : shared)
    if (weight > strongest.weight) strongest = {other, weight};
  remove_covisibility(map, *keyframe);
  keyframe->covisible.clear();
  for (const auto& [other, weight] : shared) {
    if (weight < kMinWeight && other != strongest.id) continue;
    set_covisible(*keyframe, other, weight);
    set_covisible(*map.keyframe(other), id, weight);
  }
}

void update_all_covisibility(SlamMap& map) {
  std::as_const(map).keyframes().for_each([&map](const Keyframe& k) { update_covisibility(map, k.id); });
}

}  // namespace rds::tracker
