// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/merging/map_union.hpp"

#include <utility>

namespace rds::tracker {
namespace {

/// Copies a map's contents behind those that are there.
class Appending {
 public:
  explicit Appending(MapContents& to)
      : to_(to), first_keyframe_(to.records.next_id()), first_point_(to.points.next_id()) {}

  void append(const SlamMap& map) {
    map.keyframes().for_each([&](const Keyframe& k) { append(k); });
    map.points().for_each([&](const MapPoint& p) { append(p); });
    const Keyframe* kept = nullptr;
    map.records().all().for_each([&](const KeyframeRecord& r) {
      if (const Keyframe* k = map.keyframe(r.id)) kept = k;
      append(r, map, kept);
    });
    to_.records.skip_ids(first_keyframe_ + map.records().next_id());
  }

 private:
  void append(Keyframe keyframe) {
    keyframe.id += first_keyframe_;
    keyframe.covisible.clear();
    to_.keyframes.skip_to(keyframe.id);
    to_.keyframes.emplace(std::move(keyframe));
  }
  void append(MapPoint point) {
    point.id += first_point_;
    point.created_by += first_keyframe_;
    for (Observation& o : point.observations) o.keyframe += first_keyframe_;
    to_.points.skip_to(point.id);
    to_.points.emplace(std::move(point));
  }
  void append(KeyframeRecord record, const SlamMap& map, const Keyframe* kept) {
    if (record.anchor != kNoId) {
      record.anchor_from_camera = kept->map_from_camera.inverse() * map.pose_of(record.id);
      record.anchor = kept->id + first_keyframe_;
      record.saved_pose.reset();
    }
    record.id += first_keyframe_;
    to_.records.skip_ids(record.id);
    to_.records.all().emplace(std::move(record));
  }

  MapContents& to_;
  KeyframeId first_keyframe_;
  PointId first_point_;
};

}  // namespace

tl::expected<SlamMap, std::string> unite(const SlamMap& earlier, const SlamMap& later) {
  const KeyframeId first_of_later = earlier.records().next_id();
  IdTable<KeyframeRecord> records(earlier.records().all());
  MapContents contents{earlier.keyframes(), earlier.points(),
                       KeyframeRecords(std::move(records), first_of_later)};
  contents.records.submaps().go_on(kLaterMap, first_of_later);
  Appending(contents).append(later);
  return map_of(std::move(contents), earlier.pyramid());
}

}  // namespace rds::tracker
