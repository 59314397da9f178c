// SPDX-License-Identifier: Apache-2.0
#include "services/loop_closer/feature_message.hpp"

#include <fmt/format.h>

#include "common/messages/conversions.hpp"
#include "common/messages/keyframe_conversions.hpp"

namespace rds::loop_closer {
namespace {

constexpr std::size_t kDescriptorBytes = 32;
constexpr std::size_t kMaxFeatures = 100'000;

bool lengths_fit(const rds_msgs::msg::KeyFrameFeatures& m, std::size_t features, std::size_t covisible) {
  return features <= kMaxFeatures && m.keypoints().size() == 4 * features &&
         m.descriptors().size() == kDescriptorBytes * features && m.points().size() == 3 * features &&
         m.map_point_ids().size() == features && (m.movable().empty() || m.movable().size() == features) &&
         m.covisible_weights().size() == covisible && m.covisible_poses().size() == 7 * covisible;
}

}  // namespace

tl::expected<KeyframeFeatures, std::string> to_keyframe_features(
    const rds_msgs::msg::KeyFrameFeatures& message) {
  const std::size_t count = message.points().size() / 3;
  const std::size_t covisible = message.covisible_keyframes().size();
  if (!lengths_fit(message, count, covisible))
    return tl::unexpected<std::string>("arrays of lengths that do not fit");
  KeyframeFeatures keyframe;
  keyframe.map_epoch = message.map_epoch();
  keyframe.id = message.keyframe_id();
  keyframe.stamp_ns = messages::to_nanoseconds(message.header().stamp());
  const auto map_from_camera = messages::to_pose(message.map_from_camera());
  if (!map_from_camera) return tl::unexpected(map_from_camera.error());
  keyframe.map_from_camera = *map_from_camera;
  keyframe.descriptors = cv::Mat(static_cast<int>(count), static_cast<int>(kDescriptorBytes), CV_8U,
                                 const_cast<std::uint8_t*>(message.descriptors().data()))
                             .clone();
  keyframe.points.reserve(count);
  for (std::size_t i = 0; i < count; ++i)
    keyframe.points.emplace_back(message.points()[3 * i], message.points()[3 * i + 1],
                                 message.points()[3 * i + 2]);
  keyframe.movable = message.movable();
  for (std::size_t i = 0; i < covisible; ++i)
    keyframe.covisible.push_back({message.covisible_keyframes()[i], message.covisible_weights()[i],
                                  messages::pose_at(message.covisible_poses(), i)});
  return keyframe;
}

}  // namespace rds::loop_closer
