// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "sensor_msgs/msg/PointCloud2.h"
#include "services/tracker/core/prediction/movable_objects.hpp"

namespace rds::tracker {

/// rds/obstacles: the space that predicted objects take, as points x, y, z (float32) for the obstacle layer
/// of a costmap. Each object's box, level as the map is, is filled with points kObstacleStepM apart, its
/// edges included.
sensor_msgs::msg::PointCloud2 obstacle_cloud(std::span<const ImageObject> objects,
                                             const std_msgs::msg::Header& header);

inline constexpr double kObstacleStepM = 0.1;

}  // namespace rds::tracker
