// SPDX-License-Identifier: Apache-2.0
#include "common/messages/keyframe_pose_table.hpp"

#include <algorithm>

namespace rds::messages {
namespace {

using geometry::KeyframePose;

constexpr std::size_t kMinChanges = 64;       // messages with changes between two with all poses
constexpr std::size_t kPosesPerChange = 16;   // … and one more for so many keyframes: 1.4 kB a message

bool is_same(const KeyframePose& a, const KeyframePose& b) {
  return a.id == b.id && a.stamp_ns == b.stamp_ns &&
         a.map_from_camera.matrix() == b.map_from_camera.matrix();
}

/// Poses that are not in `told`, or are there with another value; both by id.
std::vector<KeyframePose> changes_of(std::span<const KeyframePose> poses, std::span<const KeyframePose> told) {
  std::vector<KeyframePose> changed;
  auto before = told.begin();
  for (const KeyframePose& pose : poses) {
    while (before != told.end() && before->id < pose.id) ++before;
    if (before == told.end() || !is_same(*before, pose)) changed.push_back(pose);
  }
  return changed;
}

}  // namespace

bool KeyframePoseTable::take(const rds_msgs::msg::KeyFramePoses& message,
                             std::span<const KeyframePose> poses) {
  const bool all = message.base_revision() == 0;
  const bool follows = message.instance() == instance_ && message.map_epoch() == map_epoch_ &&
                       revision_ != 0 && message.base_revision() == revision_;
  if (!all && !follows) {
    clear();
    return false;
  }
  if (all) by_id_.clear();
  for (const KeyframePose& pose : poses) by_id_[pose.id] = pose;
  instance_ = message.instance();
  map_epoch_ = message.map_epoch();
  revision_ = message.revision();
  return true;
}

std::vector<KeyframePose> KeyframePoseTable::poses() const {
  std::vector<KeyframePose> poses;
  poses.reserve(by_id_.size());
  for (const auto& [id, pose] : by_id_) poses.push_back(pose);
  return poses;
}

std::vector<KeyframePose> KeyframePoseChanges::next(std::span<const KeyframePose> poses, bool somebody_new,
                                                    rds_msgs::msg::KeyFramePoses& message) {
  const bool all = revision_ == 0 || somebody_new ||
                   since_all_ >= std::max(kMinChanges, poses.size() / kPosesPerChange);
  message.base_revision(all ? 0 : revision_);
  message.revision(++revision_);
  since_all_ = all ? 0 : since_all_ + 1;
  auto changed = all ? std::vector(poses.begin(), poses.end()) : changes_of(poses, told_);
  told_.assign(poses.begin(), poses.end());
  return changed;
}

}  // namespace rds::messages
