// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "common/geometry/keyframe_pose.hpp"
#include "common/geometry/loop_match.hpp"
#include "common/geometry/pose.hpp"
#include "common/image/rgbd_frame.hpp"
#include "rds_msgs/msg/KeyFrameImages.h"
#include "rds_msgs/msg/KeyFramePoses.h"

namespace rds::messages {

/// The pictures of a keyframe, sharing the message's memory, stamped as the keyframe.
/// @return or one sentence that says what is wrong: sizes, encodings, intrinsics, a pose that is not finite.
tl::expected<image::RgbdFrame, std::string> to_rgbd_frame(
    const std::shared_ptr<const rds_msgs::msg::KeyFrameImages>& message);

/// Seven numbers x y z [m] qx qy qz qw at the end of a flat array.
void append_pose(const geometry::Pose& pose, std::vector<double>& flat);

/// Row i of such an array. @throws std::out_of_range beyond its end.
geometry::Pose pose_at(const std::vector<double>& flat, std::size_t i);

/// What is wrong with the message, in one sentence; empty if nothing: lengths, numbers that are not finite.
std::string fault_of(const rds_msgs::msg::KeyFramePoses& message);

void append_poses(std::span<const geometry::KeyframePose> poses, rds_msgs::msg::KeyFramePoses& message);
void append_loops(std::span<const geometry::LoopMatch> loops, rds_msgs::msg::KeyFramePoses& message);

/// The poses of a message. @return or fault_of().
tl::expected<std::vector<geometry::KeyframePose>, std::string> to_keyframe_poses(
    const rds_msgs::msg::KeyFramePoses& message);
/// The matches of a message that has no fault_of().
std::vector<geometry::LoopMatch> to_loops(const rds_msgs::msg::KeyFramePoses& message);

}  // namespace rds::messages
