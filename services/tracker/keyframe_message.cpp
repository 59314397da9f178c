// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/keyframe_message.hpp"

#include <cstring>

#include "common/messages/conversions.hpp"
#include "common/messages/keyframe_conversions.hpp"

namespace rds::tracker {

rds_msgs::msg::KeyFrameFeatures to_message(const KeyframeData& keyframe) {
  rds_msgs::msg::KeyFrameFeatures message;
  message.keyframe_id(keyframe.id);
  message.map_from_camera(messages::to_pose_message(keyframe.map_from_camera));
  const std::size_t count = keyframe.features.size();
  message.keypoints().reserve(4 * count);
  message.points().reserve(3 * count);
  message.descriptors().reserve(32 * count);
  for (const KeyframeFeature& f : keyframe.features) {
    const Feature& feature = f.feature;
    message.keypoints().insert(
        message.keypoints().end(),
        {feature.px.x(), feature.px.y(), static_cast<float>(feature.level), feature.angle_rad});
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(feature.descriptor.data());
    message.descriptors().insert(message.descriptors().end(), bytes, bytes + 32);
    message.points().insert(message.points().end(), f.point_in_camera.data(), f.point_in_camera.data() + 3);
    message.map_point_ids().push_back(f.map_point_id);
    message.movable().push_back(feature.movable ? 1 : 0);
  }
  for (const CovisiblePose& covisible : keyframe.covisible) {
    message.covisible_keyframes().push_back(covisible.id);
    message.covisible_weights().push_back(static_cast<std::uint32_t>(covisible.weight));
    messages::append_pose(covisible.map_from_camera, message.covisible_poses());
  }
  return message;
}

}  // namespace rds::tracker
