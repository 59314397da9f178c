// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/input/keyframe_input.hpp"

#include "common/messages/conversions.hpp"
#include "common/messages/image_conversions.hpp"
#include "common/messages/keyframe_conversions.hpp"

namespace rds::mapper {

tl::expected<KeyframeInput, std::string> to_keyframe_input(
    const std::shared_ptr<const rds_msgs::msg::KeyFrameImages>& message) {
  const auto frame = messages::to_rgbd_frame(message);
  if (!frame) return tl::unexpected(frame.error());
  const auto map_from_camera = messages::to_pose(message->map_from_camera());
  if (!map_from_camera) return tl::unexpected(map_from_camera.error());
  auto movable = messages::to_cell_mask(message->movable(), frame->color.pixels.size());
  if (!movable) return tl::unexpected(movable.error());
  return KeyframeInput{message->keyframe_id(), frame->stamp_ns, *map_from_camera, frame->color,
                       frame->depth,           frame->camera,   std::nullopt,     std::move(*movable)};
}

}  // namespace rds::mapper
