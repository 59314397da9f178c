// SPDX-License-Identifier: Apache-2.0
#include "common/messages/keyframe_conversions.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>

#include "common/messages/conversions.hpp"
#include "common/messages/image_conversions.hpp"

namespace rds::messages {
namespace {

constexpr std::size_t kPoseNumbers = 7;
constexpr std::int64_t kNsPerSecond = 1'000'000'000;
constexpr std::int64_t kMaxSeconds = std::numeric_limits<std::int32_t>::max();  // of a stamp in a header
constexpr double kFarthest_m = 1e8;

/// A member of a message that keeps the whole message alive.
template <class Member, class Message>
std::shared_ptr<const Member> part_of(const std::shared_ptr<const Message>& message, const Member& member) {
  return {message, &member};
}

/// What is wrong with an array of `count` poses.
std::string fault_of_poses(const std::vector<double>& poses, std::size_t count) {
  if (poses.size() != kPoseNumbers * count) return "arrays of lengths that do not fit";
  if (!std::ranges::all_of(poses, [](double x) { return std::abs(x) < kFarthest_m; }))
    return "a pose that is not finite, or not on this planet";
  for (std::size_t i = 0; i < count; ++i)
    if (const auto* q = &poses[kPoseNumbers * i + 3];
        std::abs(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] - 1) > 0.01)
      return "a quaternion that is no rotation";
  return {};
}

}  // namespace

tl::expected<image::RgbdFrame, std::string> to_rgbd_frame(
    const std::shared_ptr<const rds_msgs::msg::KeyFrameImages>& message) {
  auto camera = to_camera_model(message->camera_info());
  if (!camera) return tl::unexpected(camera.error());
  auto color = to_color_image(part_of(message, message->color()));
  if (!color) return tl::unexpected(color.error());
  auto depth = to_depth_image(part_of(message, message->depth()));
  if (!depth) return tl::unexpected(depth.error());
  const cv::Size size(camera->width, camera->height);
  if (color->pixels.size() != size || depth->values.size() != size)
    return tl::unexpected<std::string>("colour, depth and intrinsics are of different sizes");
  if (const auto pose = to_pose(message->map_from_camera()); !pose) return tl::unexpected(pose.error());
  return image::RgbdFrame{to_nanoseconds(message->header().stamp()), std::move(*color), std::move(*depth),
                          *camera};
}

void append_pose(const geometry::Pose& pose, std::vector<double>& flat) {
  const Eigen::Vector3d t = pose.translation();
  const Eigen::Quaterniond q(pose.linear());
  flat.insert(flat.end(), {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()});
}

geometry::Pose pose_at(const std::vector<double>& flat, std::size_t i) {
  const auto n = [&](std::size_t k) { return flat.at(kPoseNumbers * i + k); };
  return geometry::make_pose({n(0), n(1), n(2)}, Eigen::Quaterniond(n(6), n(3), n(4), n(5)));
}

std::string fault_of(const rds_msgs::msg::KeyFramePoses& message) {
  const std::size_t count = message.keyframe_ids().size();
  if (message.stamps().size() != count || message.loops().size() % 2 != 0)
    return "arrays of lengths that do not fit";
  if (std::ranges::adjacent_find(message.keyframe_ids(), std::ranges::greater_equal{}) !=
      message.keyframe_ids().end())
    return "keyframes that are not in order";
  if (!std::ranges::all_of(message.stamps(),
                           [](std::int64_t ns) { return std::abs(ns / kNsPerSecond) < kMaxSeconds; }))
    return "a stamp that no message can have";
  const std::string fault = fault_of_poses(message.poses(), count);
  return fault.empty() ? fault_of_poses(message.loop_poses(), message.loops().size() / 2) : fault;
}

void append_poses(std::span<const geometry::KeyframePose> poses, rds_msgs::msg::KeyFramePoses& message) {
  for (const geometry::KeyframePose& pose : poses) {
    message.keyframe_ids().push_back(pose.id);
    message.stamps().push_back(pose.stamp_ns);
    append_pose(pose.map_from_camera, message.poses());
  }
}

void append_loops(std::span<const geometry::LoopMatch> loops, rds_msgs::msg::KeyFramePoses& message) {
  for (const geometry::LoopMatch& loop : loops) {
    message.loops().insert(message.loops().end(), {loop.later, loop.earlier});
    append_pose(loop.earlier_from_later, message.loop_poses());
  }
}

std::vector<geometry::LoopMatch> to_loops(const rds_msgs::msg::KeyFramePoses& message) {
  std::vector<geometry::LoopMatch> loops;
  for (std::size_t i = 0; 2 * i < message.loops().size(); ++i)
    loops.push_back({message.loops()[2 * i], message.loops()[2 * i + 1], pose_at(message.loop_poses(), i)});
  return loops;
}

tl::expected<std::vector<geometry::KeyframePose>, std::string> to_keyframe_poses(
    const rds_msgs::msg::KeyFramePoses& message) {
  if (const std::string fault = fault_of(message); !fault.empty()) return tl::unexpected(fault);
  std::vector<geometry::KeyframePose> poses;
  poses.reserve(message.keyframe_ids().size());
  for (std::size_t i = 0; i < message.keyframe_ids().size(); ++i)
    poses.push_back({message.keyframe_ids()[i], message.stamps()[i], pose_at(message.poses(), i)});
  return poses;
}

}  // namespace rds::messages
