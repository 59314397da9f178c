// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <tl/expected.hpp>

#include "rds_msgs/msg/KeyFrameFeatures.h"
#include "services/loop_closer/core/loop_types.hpp"

namespace rds::loop_closer {

/// A keyframe from the bus.
/// @return or one sentence: arrays whose lengths do not fit together, a pose that is not finite.
tl::expected<KeyframeFeatures, std::string> to_keyframe_features(
    const rds_msgs::msg::KeyFrameFeatures& message);

}  // namespace rds::loop_closer
