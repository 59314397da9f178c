// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "rds_msgs/msg/KeyFrameFeatures.h"
#include "services/tracker/core/tracking_types.hpp"

namespace rds::tracker {

/// A keyframe's features as the loop closer reads them; header, epoch and frame index are left to the caller.
rds_msgs::msg::KeyFrameFeatures to_message(const KeyframeData& keyframe);

}  // namespace rds::tracker
