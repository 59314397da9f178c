// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>

#include "common/messages/keyframe_pose_table.hpp"

namespace rds::mapper {

/// Keyframe poses as the tracker has told them last, and when the map follows them: at once after a loop that
/// the tracker has confirmed, now and then after bundle adjustment. What the loop closer alone says is not
/// known here: the tracker may refuse it.
class KnownPoses {
 public:
  using Message = rds_msgs::msg::KeyFramePoses;

  /// Takes over what a message of the tracker, of the current epoch, tells. @param poses  of the message,
  /// converted.
  void take(const Message& message, const std::vector<geometry::KeyframePose>& poses);
  /// A keyframe was integrated.
  void note_keyframe() { ++since_correction_; }
  [[nodiscard]] bool is_correction_due() const;
  void note_correction();

  /// By id.
  [[nodiscard]] const std::vector<geometry::KeyframePose>& poses() const { return poses_; }
  /// The newest pose of a keyframe; nullptr if there is none.
  [[nodiscard]] const geometry::KeyframePose* find(std::uint64_t id) const;
  /// Of the newest message; 0: none.
  [[nodiscard]] std::uint64_t revision() const { return revision_; }

 private:
  messages::KeyframePoseTable table_;
  std::vector<geometry::KeyframePose> poses_;
  std::pair<std::uint64_t, std::uint64_t> loops_;  // that poses_ contains: loop closer's instance, revision
  std::uint64_t revision_ = 0;
  bool has_new_loop_ = false;
  int since_correction_ = 0;  // keyframes
};

}  // namespace rds::mapper
