// SPDX-License-Identifier: Apache-2.0
#include "common/messages/keyframe_pose_table.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace rds::messages {
namespace {

using geometry::KeyframePose;

constexpr std::size_t kMinChanges = 64;      // messages with changes between two with all poses
constexpr std::size_t kPosesPerChange = 16;  // … and one more for so many keyframes: 1.4 kB a message

constexpr double kMoved_m = 1e-3;
constexpr double kTurned_rad = 3.5e-4;

bool is_nearly(const KeyframePose& a, const KeyframePose& b) {
  const Eigen::Matrix4d change = a.map_from_camera.matrix() - b.map_from_camera.matrix();
  return a.stamp_ns == b.stamp_ns && change.topRightCorner<3, 1>().norm() <= kMoved_m &&
         change.topLeftCorner<3, 3>().norm() <= std::sqrt(2.0) * kTurned_rad;
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

std::vector<KeyframePose> MovedKeyframes::next(std::span<const KeyframePose> poses) {
  std::vector<KeyframePose> moved;
  std::vector<KeyframePose> told_now(poses.begin(), poses.end());
  auto before = told_.begin();
  for (KeyframePose& pose : told_now) {
    while (before != told_.end() && before->id < pose.id) ++before;
    if (before != told_.end() && before->id == pose.id && is_nearly(*before, pose))
      pose = *before;
    else
      moved.push_back(pose);
  }
  told_ = std::move(told_now);
  return moved;
}

std::vector<KeyframePose> KeyframePoseChanges::next(std::span<const KeyframePose> poses, bool all,
                                                    rds_msgs::msg::KeyFramePoses& message) {
  all = all || revision_ == 0 || since_all_ >= std::max(kMinChanges, poses.size() / kPosesPerChange);
  message.base_revision(all ? 0 : revision_);
  message.revision(++revision_);
  since_all_ = all ? 0 : since_all_ + 1;
  if (!all) return moved_.next(poses);
  moved_.tell_all(poses);
  return {poses.begin(), poses.end()};
}

}  // namespace rds::messages
