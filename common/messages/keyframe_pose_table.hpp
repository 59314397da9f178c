// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "common/geometry/keyframe_pose.hpp"
#include "rds_msgs/msg/KeyFramePoses.h"

namespace rds::messages {

/// KeyFramePoses.source: as the tracker has them, as the loop closer proposes, or as the tracker has them in
/// a submap.
inline constexpr std::uint8_t kPosesOfTracker = 0;
inline constexpr std::uint8_t kPosesOfLoopCloser = 1;
inline constexpr std::uint8_t kPosesOfSubmap = 2;

/// A reader's side of rds/keyframe/poses: what one writer has told, from messages with all poses and from
/// messages with changes.
class KeyframePoseTable {
 public:
  /// @param poses  of the message, converted. @return false if the message changes poses that were not told
  /// here: one before it was missed, and nothing is known until one with all poses comes.
  bool take(const rds_msgs::msg::KeyFramePoses& message, std::span<const geometry::KeyframePose> poses);

  /// By id.
  [[nodiscard]] std::vector<geometry::KeyframePose> poses() const;
  void clear() { *this = {}; }

 private:
  std::map<std::uint64_t, geometry::KeyframePose> by_id_;
  std::uint64_t instance_ = 0;
  std::uint64_t map_epoch_ = 0;
  std::uint64_t revision_ = 0;  // 0: nothing is known
};

/// Which keyframes are new or have moved since the last call, by more than bundle adjustment moves everything
/// all the time: 1 mm or 0.02°.
class MovedKeyframes {
 public:
  /// @param poses  all, by id.
  std::vector<geometry::KeyframePose> next(std::span<const geometry::KeyframePose> poses);
  /// All are taken as told.
  void tell_all(std::span<const geometry::KeyframePose> poses) { told_.assign(poses.begin(), poses.end()); }
  void clear() { told_.clear(); }

 private:
  std::vector<geometry::KeyframePose> told_;
};

/// The writer's side: which poses a message has to carry.
///
/// All of them first, when that is asked for, and after so many messages that what they add to each one stays
/// the same however many keyframes there are; else MovedKeyframes.
class KeyframePoseChanges {
 public:
  /// @param poses  all, by id. @param all  somebody has joined, or needs the exact poses.
  /// @return those to be told; revision and base_revision of the message are set.
  std::vector<geometry::KeyframePose> next(std::span<const geometry::KeyframePose> poses, bool all,
                                           rds_msgs::msg::KeyFramePoses& message);
  /// Of the last message; 0 before the first.
  [[nodiscard]] std::uint64_t revision() const { return revision_; }
  /// Another map: revisions count anew.
  void clear() { *this = {}; }

 private:
  MovedKeyframes moved_;
  std::uint64_t revision_ = 0;
  std::size_t since_all_ = 0;  // messages
};

}  // namespace rds::messages
