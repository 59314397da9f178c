// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/messages/conversions.hpp"
#include "common/messages/keyframe_pose_table.hpp"
#include "rds_msgs/msg/TrackingState.h"

namespace rds::viewer {

/// What the tracker tells of the submap in which its camera is, and which has no place in the map. Poses are
/// in the submap's own frame.
class SubmapView {
 public:
  using Poses = std::span<const geometry::KeyframePose>;

  void take(const rds_msgs::msg::KeyFramePoses& message, Poses poses) {
    if (!known_.take(message, poses)) return;
    for (const auto& keyframe : poses) newest_ = std::max(newest_, keyframe.id);
  }
  /// The camera is in the map: the submap was joined to it, or left.
  /// @return whether there was something to forget.
  bool leave() {
    const bool was_there = newest_ > left_;
    left_ = newest_;
    return was_there;
  }
  void clear() { *this = {}; }

  /// Of the submap where the camera is, by id.
  [[nodiscard]] std::vector<geometry::KeyframePose> keyframes() const {
    auto poses = known_.poses();
    std::erase_if(poses, [this](const auto& keyframe) { return keyframe.id <= left_; });
    return poses;
  }

  /// The camera in the submap; nothing where the frame's reference keyframe was not told.
  [[nodiscard]] std::optional<geometry::Pose> camera(const rds_msgs::msg::TrackingState& state) const {
    const auto poses = known_.poses();
    const auto reference =
        std::ranges::find(poses, state.reference_keyframe_id(), &geometry::KeyframePose::id);
    const auto reference_from_camera = messages::to_pose(state.reference_from_camera());
    if (reference == poses.end() || !reference_from_camera) return std::nullopt;
    return geometry::Pose(reference->map_from_camera * *reference_from_camera);
  }

 private:
  messages::KeyframePoseTable known_;
  std::uint64_t newest_ = 0;
  std::uint64_t left_ = 0;  // keyframes up to this one are of submaps that the camera is no longer in
};

}  // namespace rds::viewer
