// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/labelled_boxes.hpp"

#include "common/messages/conversions.hpp"
#include "common/messages/detection_conversions.hpp"

namespace rds::mapper {

messages::Expected<std::vector<LabelledBox>> to_labelled_boxes(
    const vision_msgs::msg::Detection3DArray& message, const geometry::Pose& camera_from_map,
    const geometry::CameraModel& camera, const MapperConfig& config) {
  const auto detections = messages::to_detections(message);
  if (!detections) return tl::unexpected(detections.error());
  std::vector<LabelledBox> labelled;
  for (const auto& [label, score, box, id] : *detections) {
    if (!geometry::is_valid(box)) continue;
    const auto box_px = geometry::image_box(box, camera_from_map, camera);
    if (!box_px) continue;
    const auto depth_m = static_cast<float>((camera_from_map * box.center()).z());
    labelled.push_back({label, score, *box_px, std::nullopt, depth_m, config.is_movable(label)});
  }
  return labelled;
}

}  // namespace rds::mapper
