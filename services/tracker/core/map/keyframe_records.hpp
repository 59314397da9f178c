// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <map>
#include <optional>

#include "services/tracker/core/map/id_table.hpp"
#include "services/tracker/core/map/keyframe.hpp"
#include "services/tracker/core/map/submaps.hpp"

namespace rds::tracker {

/// What stays of a keyframe. While the map holds it, its pose is there; afterwards it is relative to another
/// keyframe, the anchor, and moves with that.
struct KeyframeRecord {
  KeyframeId id = kNoId;
  std::int64_t stamp_ns = 0;
  KeyframeId anchor = kNoId;  // kNoId while the map holds the keyframe
  Pose anchor_from_camera = Pose::Identity();
  bool pose_only = false;  // never was in the map: no other pose is relative to it
  std::optional<Pose> saved_pose =
      std::nullopt;  // map_from_camera to the bit, of one whose anchor never moves
};

/// The records of every keyframe that ever was. Gives keyframes their ids, none of them twice.
class KeyframeRecords {
 public:
  KeyframeRecords() = default;
  /// @param first_free  as first_free().
  KeyframeRecords(IdTable<KeyframeRecord>&& records, KeyframeId first_free);

  /// A record of a keyframe that the map holds from now on. @return its id.
  KeyframeId add(std::int64_t stamp_ns) { return add({kNoId, stamp_ns, kNoId, Pose::Identity(), false}); }
  /// Of one that was culled in a saved map, whose keyframes never move. @param anchor_from_camera  where
  /// map_from_camera is in the anchor.
  KeyframeId add_saved(std::int64_t stamp_ns, KeyframeId anchor, const Pose& anchor_from_camera,
                       const Pose& map_from_camera) {
    return add({kNoId, stamp_ns, anchor, anchor_from_camera, false, map_from_camera});
  }
  /// Of one that never was in the map.
  KeyframeId add_pose_only(std::int64_t stamp_ns, KeyframeId anchor, const Pose& anchor_from_camera);
  /// Forgets those with this anchor that never were in the map, but for those of the last minute and for the
  /// 20 newest: a camera that stays in a known place makes one every second.
  void forget_pose_only(KeyframeId anchor, std::int64_t now_ns);
  /// The pose of a culled keyframe.
  void set_anchor(KeyframeId id, KeyframeId anchor, const Pose& anchor_from_camera);

  [[nodiscard]] bool contains(KeyframeId id) const { return records_.find(id) != nullptr; }
  /// @throws std::out_of_range for an unknown id.
  [[nodiscard]] const KeyframeRecord& operator[](KeyframeId id) const;
  /// The keyframe of the map that a pose is relative to in the end, and that pose.
  /// @throws std::out_of_range for an unknown id.
  [[nodiscard]] std::pair<KeyframeId, Pose> anchor_of(KeyframeId id) const;

  /// The id that is given next.
  [[nodiscard]] KeyframeId next_id() const { return records_.next_id(); }
  /// Uses up the ids below this one: somebody may know them.
  void skip_ids(KeyframeId next) { records_.skip_to(next); }
  /// Makes the keyframes there are so far the gauge: they are never moved nor culled.
  void fix_all() { first_free_ = next_id(); }
  [[nodiscard]] KeyframeId first_free() const { return first_free_; }
  [[nodiscard]] bool is_fixed(KeyframeId id) const { return id < first_free_; }

  /// Which of them are in the map, and which in a submap that has no place in it yet.
  Submaps& submaps() { return submaps_; }
  [[nodiscard]] const Submaps& submaps() const { return submaps_; }
  /// Whether a keyframe has a place in the map.
  [[nodiscard]] bool is_placed(KeyframeId id) const { return submaps_.of(id) == Submaps::kMap; }

  IdTable<KeyframeRecord>& all() { return records_; }
  [[nodiscard]] const IdTable<KeyframeRecord>& all() const { return records_; }

 private:
  KeyframeId add(KeyframeRecord record);

  IdTable<KeyframeRecord> records_;
  std::map<KeyframeId, std::deque<KeyframeId>> pose_only_;  // by anchor, oldest first
  KeyframeId first_free_ = 0;
  Submaps submaps_;
};

}  // namespace rds::tracker
