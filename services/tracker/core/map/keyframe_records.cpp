// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/map/keyframe_records.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

namespace rds::tracker {
namespace {

constexpr double kPoseOnlyS = 60;            // that poses alone are kept, and …
constexpr std::size_t kPoseOnlyNewest = 20;  // … so many per anchor, however old

}  // namespace

KeyframeRecords::KeyframeRecords(IdTable<KeyframeRecord>&& records, KeyframeId first_free)
    : records_(std::move(records)), first_free_(first_free) {
  std::as_const(records_).for_each([this](const KeyframeRecord& r) {
    if (r.pose_only) pose_only_[r.anchor].push_back(r.id);
  });
}

KeyframeId KeyframeRecords::add(KeyframeRecord record) {
  record.id = next_id();
  return records_.emplace(record).id;
}

KeyframeId KeyframeRecords::add_pose_only(std::int64_t stamp_ns, KeyframeId anchor,
                                          const Pose& anchor_from_camera) {
  const KeyframeId id = add({kNoId, stamp_ns, anchor, anchor_from_camera, true});
  pose_only_[anchor].push_back(id);
  return id;
}

void KeyframeRecords::forget_pose_only(KeyframeId anchor, std::int64_t now_ns) {
  std::deque<KeyframeId>& ids = pose_only_[anchor];
  while (ids.size() > kPoseOnlyNewest) {
    const auto age_s = static_cast<double>(now_ns - (*this)[ids.front()].stamp_ns) * 1e-9;
    if (std::abs(age_s) <= kPoseOnlyS) return;
    records_.erase(ids.front());
    ids.pop_front();
  }
}

void KeyframeRecords::set_anchor(KeyframeId id, KeyframeId anchor, const Pose& anchor_from_camera) {
  if (KeyframeRecord* record = records_.find(id)) {
    record->anchor = anchor;
    record->anchor_from_camera = anchor_from_camera;
    record->saved_pose.reset();
  }
}

const KeyframeRecord& KeyframeRecords::operator[](KeyframeId id) const {
  const KeyframeRecord* record = records_.find(id);
  if (record == nullptr) throw std::out_of_range("KeyframeRecords: no such keyframe");
  return *record;
}

std::pair<KeyframeId, Pose> KeyframeRecords::anchor_of(KeyframeId id) const {
  Pose keyframe_from_camera = Pose::Identity();
  const KeyframeRecord* r = &(*this)[id];
  for (; r->anchor != kNoId; r = &(*this)[r->anchor])
    keyframe_from_camera = r->anchor_from_camera * keyframe_from_camera;
  return {r->id, keyframe_from_camera};
}

}  // namespace rds::tracker
