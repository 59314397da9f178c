// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/messages/keyframe_pose_table.hpp"
#include "services/mapper/input/loop_revisions.hpp"

namespace rds::mapper {

/// Keyframe poses as the tracker's local bundle adjustment and the loop closer have told them last, and when
/// the map follows them: at once after a loop correction, now and then after local bundle adjustment.
class KnownPoses {
 public:
  using Message = rds_msgs::msg::KeyFramePoses;

  /// True for poses from local bundle adjustment, false for the loop closer's.
  static bool is_local(const Message& message) { return message.source() == 0; }

  /// Takes over what a message of the current epoch tells, unless a loop correction is missing in it that is
  /// known already. @param poses  of the message, converted.
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
  bool has_new_loop_ = false;
  int since_correction_ = 0;  // keyframes
};

}  // namespace rds::mapper
