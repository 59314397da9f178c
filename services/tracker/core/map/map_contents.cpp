// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/map/map_contents.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "services/tracker/core/map/covisibility.hpp"

namespace rds::tracker {
namespace {

/// Why a record has no pose, or nothing.
std::string fault_of(const MapContents& contents, const KeyframeRecord& record) {
  const IdTable<KeyframeRecord>& records = contents.records.all();
  const KeyframeRecord* r = &record;
  std::size_t steps = 0;
  while (r != nullptr && r->anchor != kNoId && ++steps <= records.size()) r = records.find(r->anchor);
  const bool is_anchored = r != nullptr && r->anchor == kNoId && contents.keyframes.find(r->id) != nullptr;
  return is_anchored ? "" : fmt::format("the pose of keyframe {} is relative to none of the map", record.id);
}

/// Lets the features see a point that knows which ones do. @return why that cannot be, or nothing.
std::string connect(IdTable<Keyframe>& keyframes, const MapPoint& point) {
  const auto unsorted =
      std::ranges::adjacent_find(point.observations, std::ranges::greater_equal{}, &Observation::keyframe);
  if (point.observations.empty() || unsorted != point.observations.end())
    return fmt::format("point {} that no keyframe sees, or one twice", point.id);
  for (const Observation& o : point.observations) {
    Keyframe* k = keyframes.find(o.keyframe);
    const bool is_free = k != nullptr && o.feature < k->points.size() && !k->movable[o.feature] &&
                         k->points[o.feature] == kNoId;
    if (!is_free) return fmt::format("point {} in keyframe {}, where it cannot be", point.id, o.keyframe);
    k->points[o.feature] = point.id;
  }
  return {};
}

}  // namespace

tl::expected<SlamMap, std::string> map_of(MapContents&& contents, const ScalePyramid& pyramid) {
  contents.records.skip_ids(contents.keyframes.next_id());
  std::string fault;
  const auto note = [&fault](std::string what) {
    if (fault.empty()) fault = std::move(what);
  };
  contents.keyframes.for_each([&](Keyframe& k) {
    k.points.assign(k.features->size(), kNoId);
    if (!contents.records.contains(k.id)) note(fmt::format("keyframe {} without a record", k.id));
  });
  std::as_const(contents.records).all().for_each([&](const KeyframeRecord& r) {
    note(fault_of(contents, r));
  });
  std::as_const(contents.points).for_each([&](const MapPoint& p) { note(connect(contents.keyframes, p)); });
  if (!fault.empty()) return tl::unexpected(fault);
  SlamMap map(pyramid, std::move(contents));
  map.points().for_each([&](MapPoint& p) { update_from_observations(map, p); });
  update_all_covisibility(map);
  return map;
}

}  // namespace rds::tracker
