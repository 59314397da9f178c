// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "common/geometry/box.hpp"
#include "common/geometry/oriented_box.hpp"
#include "common/messages/conversions.hpp"
#include "vision_msgs/msg/Detection2DArray.h"
#include "vision_msgs/msg/Detection3DArray.h"

namespace rds::messages {

/// A labelled box in a picture [px] and the depth of what it shows.
struct ImageDetection {
  std::string label;
  float score = 0;
  geometry::Box2 box;
  float depth_m = 0;  // 0: unknown
};

/// What else a detection may be of.
struct OtherLabel {
  std::string label;
  float score = 0;
};

/// A labelled box in the frame of the message's header [m].
struct SpatialDetection {
  std::string label;
  float score = 0;
  geometry::OrientedBox box;
  std::string id;                        // of the object, may be empty
  std::vector<OtherLabel> or_else = {};  // with lower scores
};

/// Each detection with its best hypothesis (class_id = label, pose.position.z = depth); a detection without
/// hypothesis is left out, and so are the other hypotheses. A rotated image box becomes the upright one
/// around it.
///
/// @return an error naming the detection with a value that is not finite or a negative size.
Expected<std::vector<ImageDetection>> to_detections(const vision_msgs::msg::Detection2DArray& message);
Expected<std::vector<SpatialDetection>> to_detections(const vision_msgs::msg::Detection3DArray& message);

/// One hypothesis per detection, and after it those of or_else; headers as of the whole message.
vision_msgs::msg::Detection2DArray to_detection_message(std::span<const ImageDetection> detections,
                                                        const std_msgs::msg::Header& header);
vision_msgs::msg::Detection3DArray to_detection_message(std::span<const SpatialDetection> detections,
                                                        const std_msgs::msg::Header& header);

}  // namespace rds::messages
