// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "common/messages/conversions.hpp"
#include "common/service/diagnostics.hpp"
#include "rds_msgs/msg/KeyFrameImages.h"
#include "services/mapper/core/config/mapper_config.hpp"
#include "services/mapper/core/keyframe/keyframe_input.hpp"
#include "services/mapper/input/keyframe_queue.hpp"
#include "vision_msgs/msg/Detection3DArray.h"

namespace rds::mapper {

/// A keyframe from the bus, without boxes; its pictures share the message's memory.
/// @return or one sentence that says what is wrong: sizes, encodings, intrinsics, a pose that is not finite.
messages::Expected<KeyframeInput> to_keyframe_input(
    const std::shared_ptr<const rds_msgs::msg::KeyFrameImages>& message);

/// Boxes from the bus, brought back into their keyframe's picture. What cannot be of an object in it (without
/// extent, larger than a room, not in the picture, no label, no score) is left out and counted as "impossible
/// boxes".
/// @return nullopt, rejected, for a message with a value that is not finite or a negative size.
std::optional<std::vector<LabelledBox>> to_labelled_boxes(const vision_msgs::msg::Detection3DArray& message,
                                                          const IntegratedKeyframe& keyframe,
                                                          const MapperConfig& config,
                                                          service::Diagnostics& diagnostics);

}  // namespace rds::mapper
