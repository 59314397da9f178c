// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>

#include "common/messages/keyframe_pose_table.hpp"

namespace rds::mapper {

/// Which corrections of which loop closer the known keyframe poses contain.
///
/// Revisions count per loop closer's instance: one that was started again begins at 0, and what it finds is
/// newer than all of those before it.
class LoopRevisions {
 public:
  /// Poses that contain this correction were made before their writer knew what we know.
  [[nodiscard]] bool is_older(std::uint64_t instance, std::uint64_t revision) const {
    return instance == instance_
               ? revision < revision_
               : revision_ > 0 && (instance == 0 || std::ranges::count(earlier_, instance) > 0);
  }
  [[nodiscard]] bool is_newer(std::uint64_t instance, std::uint64_t revision) const {
    return !is_older(instance, revision) && (instance == instance_ ? revision > revision_ : revision > 0);
  }
  void take(std::uint64_t instance, std::uint64_t revision) {
    if (instance != instance_ && instance_ != 0) earlier_.push_back(instance_);
    if (earlier_.size() > kMaxEarlier) earlier_.pop_front();
    instance_ = instance;
    revision_ = revision;
  }

 private:
  static constexpr std::size_t kMaxEarlier = 16;
  std::uint64_t instance_ = 0;
  std::uint64_t revision_ = 0;
  std::deque<std::uint64_t> earlier_;
};

/// Keyframe poses as the tracker's local bundle adjustment and the loop closer have told them last, and when
/// the map follows them: at once after a loop correction, now and then after local bundle adjustment.
class KnownPoses {
 public:
  using Message = rds_msgs::msg::KeyFramePoses;

  /// True for poses from local bundle adjustment, false for the loop closer's.
  static bool is_local(const Message& message) { return message.source() == 0; }

  /// Takes over what a message of the current epoch tells, unless a loop correction is missing in it that is
  /// known already; but what the tracker goes on without for long is given up. @param poses  of the message, converted.
  void take(const Message& message, std::vector<geometry::KeyframePose> poses);
  /// A keyframe was integrated.
  void note_keyframe() { ++since_correction_; }
  [[nodiscard]] bool is_correction_due() const;
  void note_correction();
  /// Another loop closer counts its corrections anew.
  void forget_loops() { loops_ = {}; }

  /// By id.
  [[nodiscard]] const std::vector<geometry::KeyframePose>& poses() const { return poses_; }
  /// The newest pose of a keyframe; nullptr if there is none.
  [[nodiscard]] const geometry::KeyframePose* find(std::uint64_t id) const;
  /// As the tracker alone has told them, by id.
  [[nodiscard]] std::vector<geometry::KeyframePose> poses_of_tracker() const { return tracker_.poses(); }
  /// Of the tracker's newest message; 0: none.
  [[nodiscard]] std::uint64_t revision() const { return revision_; }

 private:
  messages::KeyframePoseTable tracker_;
  std::vector<geometry::KeyframePose> poses_;
  LoopRevisions loops_;  // that poses_ contains
  std::uint64_t revision_ = 0;
  int messages_without_loop_ = 0;  // of the tracker, in a row
  bool has_new_loop_ = false;
  int since_correction_ = 0;  // keyframes
};

}  // namespace rds::mapper
