// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core.hpp>

#include "rds_msgs/msg/FrameFeatures.h"
#include "tools/rds/run/results/recording.hpp"

namespace rds::run {

/// The picture with the features that were kept (green: support the pose, grey: not matched) and removed
/// (red), what was cut out by depth as movable (tinted red), the predicted boxes with id, label and speed,
/// and the tracking state.
cv::Mat draw_overlay(const cv::Mat& bgr, const rds_msgs::msg::FrameFeatures& features,
                     const std::vector<PredictionRecord>& boxes, const FrameRecord& frame);

}  // namespace rds::run
