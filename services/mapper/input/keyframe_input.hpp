// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <tl/expected.hpp>

#include "rds_msgs/msg/KeyFrameImages.h"
#include "services/mapper/core/keyframe/keyframe_input.hpp"

namespace rds::mapper {

/// A keyframe from the bus, without boxes; its pictures share the message's memory.
/// @return or one sentence that says what is wrong: sizes, encodings, intrinsics, a pose that is not finite.
tl::expected<KeyframeInput, std::string> to_keyframe_input(
    const std::shared_ptr<const rds_msgs::msg::KeyFrameImages>& message);

}  // namespace rds::mapper
