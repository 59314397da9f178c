// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "nav_msgs/msg/OccupancyGrid.h"
#include "octomap_msgs/msg/Octomap.h"
#include "rds_msgs/msg/OctreeDelta.h"
#include "sensor_msgs/msg/PointCloud2.h"
#include "services/mapper/core/map_snapshot.hpp"
#include "services/mapper/core/octree/occupancy_grid.hpp"
#include "vision_msgs/msg/Detection3DArray.h"
#include "visualization_msgs/msg/MarkerArray.h"

/// The map as messages; all in frame `map` and with the stamp of the newest keyframe in it, unless told
/// otherwise.
namespace rds::mapper {

rds_msgs::msg::OctreeDelta to_message(const MapDelta& delta);

/// rds/map/full: octomap_msgs::fullMsgToMap() makes a ColorOcTree of it.
octomap_msgs::msg::Octomap full_message(const MapSnapshot& snapshot, std::int64_t stamp_ns);
/// rds/map/binary: octomap_msgs::binaryMsgToMap() makes an OcTree of it.
octomap_msgs::msg::Octomap binary_message(const octomap::ColorOcTree& tree, std::int64_t stamp_ns);
/// rds/map/points: x, y, z, rgb, label of occupied voxels, as PCL's PointXYZRGBL.
sensor_msgs::msg::PointCloud2 points_message(const MapPoints& points, std::int64_t stamp_ns);

/// The upright boxes of those that have not gone, as below; a hypothesis for each label, the most probable
/// one first, scored by the detector's mean score and the label's probability.
vision_msgs::msg::Detection3DArray objects_message(std::span<const MapObject> objects, std::int64_t stamp_ns);
/// An upright box and a text for each object, after the deletion of all earlier ones.
visualization_msgs::msg::MarkerArray markers_message(std::span<const MapObject> objects,
                                                     std::int64_t stamp_ns);
nav_msgs::msg::OccupancyGrid grid_message(const OccupancyGrid& grid, std::int64_t stamp_ns);

}  // namespace rds::mapper
