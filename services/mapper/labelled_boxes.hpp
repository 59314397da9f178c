// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/messages/conversions.hpp"
#include "services/mapper/core/mapper_config.hpp"
#include "services/mapper/core/types.hpp"
#include "vision_msgs/msg/Detection3DArray.h"

namespace rds::mapper {

/// Boxes from the bus, brought back into the keyframe's picture; those without extent or not in the
/// picture are left out.
///
/// @return an error naming the detection with a value that is not finite or a negative size.
/// @param camera_from_map  of the keyframe when it was made: with this pose the boxes were lifted into the
/// map.
messages::Expected<std::vector<LabelledBox>> to_labelled_boxes(
    const vision_msgs::msg::Detection3DArray& message, const geometry::Pose& camera_from_map,
    const geometry::CameraModel& camera, const MapperConfig& config);

}  // namespace rds::mapper
