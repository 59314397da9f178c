// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/messages/conversions.hpp"
#include "services/mapper/core/config/mapper_config.hpp"
#include "services/mapper/core/keyframe/keyframe_input.hpp"
#include "vision_msgs/msg/Detection3DArray.h"

namespace rds::mapper {

/// A keyframe's boxes, and how many could not be of an object in it.
struct KeyframeBoxes {
  std::vector<LabelledBox> boxes;
  std::size_t impossible = 0;  // without extent, larger than a room, not in the picture, no label, no score
};

/// Boxes from the bus, brought back into the keyframe's picture.
///
/// @return an error naming the detection with a value that is not finite or a negative size.
/// @param camera_from_map  of the keyframe when it was made: with this pose the boxes were lifted into the
/// map.
messages::Expected<KeyframeBoxes> to_labelled_boxes(const vision_msgs::msg::Detection3DArray& message,
                                                    const geometry::Pose& camera_from_map,
                                                    const geometry::CameraModel& camera,
                                                    const MapperConfig& config);

}  // namespace rds::mapper
