// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/input/conversions.hpp"

#include "common/messages/detection_conversions.hpp"
#include "common/messages/image_conversions.hpp"
#include "common/messages/keyframe_conversions.hpp"
#include "common/topics/topics.hpp"

namespace rds::mapper {
namespace {

constexpr double kMaxSizeM = 20;
constexpr std::size_t kMaxLabelBytes = 64;

bool is_possible(const messages::SpatialDetection& detection) {
  return geometry::is_valid(detection.box) && detection.box.size.maxCoeff() <= kMaxSizeM &&
         !detection.label.empty() && detection.label.size() <= kMaxLabelBytes && detection.score >= 0 &&
         detection.score <= 1;
}

}  // namespace

messages::Expected<KeyframeInput> to_keyframe_input(
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

std::optional<std::vector<LabelledBox>> to_labelled_boxes(const vision_msgs::msg::Detection3DArray& message,
                                                          const IntegratedKeyframe& keyframe,
                                                          const MapperConfig& config,
                                                          service::Diagnostics& diagnostics) {
  const auto detections = messages::to_detections(message);
  if (!detections) {
    diagnostics.reject(topics::kBoxes.name, service::Rejection::kInvalid, detections.error());
    return std::nullopt;
  }
  auto& impossible = diagnostics.counter("impossible boxes");
  std::vector<LabelledBox> boxes;
  for (const auto& detection : *detections) {
    const auto& [label, score, box, id, or_else] = detection;
    const auto box_px = geometry::image_box(box, keyframe.camera_from_map, keyframe.camera);
    if (!is_possible(detection) || !box_px) {
      ++impossible;
      continue;
    }
    const auto depth_m = static_cast<float>((keyframe.camera_from_map * box.center()).z());
    boxes.push_back({label, score, *box_px, std::nullopt, depth_m, config.is_movable(label)});
  }
  return boxes;
}

}  // namespace rds::mapper
