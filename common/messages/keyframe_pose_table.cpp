// SPDX-License-Identifier: Apache-2.0
#include "common/messages/keyframe_pose_table.hpp"

#include <algorithm>
#include <cmath>

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

/// Poses that are not in `told`, or are there with another value; both by id. `told` is what it is after
/// them.
std::vector<KeyframePose> changes_of(std::span<const KeyframePose> poses, std::vector<KeyframePose>& told) {
  std::vector<KeyframePose> changed;
  std::vector<KeyframePose> told_now(poses.begin(), poses.end());
  auto before = told.begin();
  for (KeyframePose& pose : told_now) {
    while (before != told.end() && before->id < pose.id) ++before;
    if (before != told.end() && before->id == pose.id && is_nearly(*before, pose))
      pose = *before;
    else
      changed.push_back(pose);
  }
  told = std::move(told_now);
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

std::vector<KeyframePose> KeyframePoseChanges::next(std::span<const KeyframePose> poses, bool all,
                                                    rds_msgs::msg::KeyFramePoses& message) {
  all = all || revision_ == 0 || since_all_ >= std::max(kMinChanges, poses.size() / kPosesPerChange);
  message.base_revision(all ? 0 : revision_);
  message.revision(++revision_);
  since_all_ = all ? 0 : since_all_ + 1;
  if (!all) return changes_of(poses, told_);
  told_.assign(poses.begin(), poses.end());
  return told_;
}

}  // namespace rds::messages
