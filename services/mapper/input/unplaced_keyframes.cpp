// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/input/unplaced_keyframes.hpp"

#include <utility>

namespace rds::mapper {

bool UnplacedKeyframes::has_no_place(const KeyframeQueue::Entry& entry, const KnownPoses& poses) {
  return entry.images->submap() != 0 && poses.find(entry.images->keyframe_id()) == nullptr;
}

void UnplacedKeyframes::hold(KeyframeQueue::Entry entry) {
  const std::uint64_t id = entry.images->keyframe_id();
  keyframes_.insert_or_assign(id, std::move(entry));
  if (keyframes_.size() <= capacity_) return;
  bool goes = false;
  std::erase_if(keyframes_, [&](const auto&) { return std::exchange(goes, !goes); });
  dropped_ += capacity_ + 1 - keyframes_.size();
}

std::optional<KeyframeQueue::Entry> UnplacedKeyframes::take_placed(const KnownPoses& poses) {
  for (auto keyframe = keyframes_.begin(); keyframe != keyframes_.end(); ++keyframe)
    if (poses.find(keyframe->first) != nullptr) return keyframes_.extract(keyframe).mapped();
  looked_at_ = poses.revision();
  return std::nullopt;
}

}  // namespace rds::mapper
