// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/input/labelled_boxes.hpp"

#include "common/messages/conversions.hpp"
#include "common/messages/detection_conversions.hpp"

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

messages::Expected<KeyframeBoxes> to_labelled_boxes(const vision_msgs::msg::Detection3DArray& message,
                                                    const geometry::Pose& camera_from_map,
                                                    const geometry::CameraModel& camera,
                                                    const MapperConfig& config) {
  const auto detections = messages::to_detections(message);
  if (!detections) return tl::unexpected(detections.error());
  KeyframeBoxes labelled;
  for (const auto& detection : *detections) {
    const auto& [label, score, box, id] = detection;
    const auto box_px = geometry::image_box(box, camera_from_map, camera);
    if (!is_possible(detection) || !box_px) {
      ++labelled.impossible;
      continue;
    }
    const auto depth_m = static_cast<float>((camera_from_map * box.center()).z());
    labelled.boxes.push_back({label, score, *box_px, std::nullopt, depth_m, config.is_movable(label)});
  }
  return labelled;
}

}  // namespace rds::mapper
