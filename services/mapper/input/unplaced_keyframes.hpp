// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <optional>

#include "services/mapper/input/keyframe_queue.hpp"
#include "services/mapper/input/known_poses.hpp"

namespace rds::mapper {

/// Keyframes of submaps, with their boxes: they have no place in the map until the tracker tells one. When
/// full, every other one is dropped and counted; those that are left still show all of the submap.
class UnplacedKeyframes {
 public:
  /// @param capacity  keyframes, at least 2.
  explicit UnplacedKeyframes(std::size_t capacity) : capacity_(capacity) {}

  /// Whether a keyframe has to wait here.
  [[nodiscard]] static bool has_no_place(const KeyframeQueue::Entry& entry, const KnownPoses& poses);
  void hold(KeyframeQueue::Entry entry);
  /// The oldest keyframe that has a place now; nullopt if none has.
  std::optional<KeyframeQueue::Entry> take_placed(const KnownPoses& poses);
  /// Whether take_placed() has not been asked since these poses came.
  [[nodiscard]] bool may_be_placed(const KnownPoses& poses) const {
    return !keyframes_.empty() && poses.revision() != looked_at_;
  }
  void clear() { keyframes_.clear(); }

  [[nodiscard]] std::size_t size() const { return keyframes_.size(); }
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }

 private:
  std::size_t capacity_;
  std::map<std::uint64_t, KeyframeQueue::Entry> keyframes_;  // by id
  std::uint64_t looked_at_ = 0;                              // revision of the poses, which placed none
  std::uint64_t dropped_ = 0;
};

}  // namespace rds::mapper
