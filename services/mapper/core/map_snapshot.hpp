// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/mapper/core/semantic_mapper.hpp"

namespace rds::mapper {

/// The map at one revision: all that another thread needs to tell others of it while the mapper goes on.
struct MapSnapshot {
  double resolution = 0;                          // [m]
  std::vector<std::uint8_t> nodes;                // as to_bytes() gives them
  std::vector<std::uint16_t> labels_of_occupied;  // of each occupied voxel, in the order of for_each_voxel()
  std::vector<std::string> labels;                // label table
  std::vector<MapObject> objects;
  Eigen::Vector3d up = -Eigen::Vector3d::UnitY();
};

MapSnapshot take_snapshot(const SemanticMapper& mapper);

/// Labels that a reader of the full map cannot tell from colours (ColorLabels).
struct LabelRows {
  std::vector<std::uint16_t> keys;    // 3N
  std::vector<std::uint16_t> values;  // N
};
/// @param tree  of the snapshot's nodes.
LabelRows labels_not_shown_by_colors(const octomap::ColorOcTree& tree, const MapSnapshot& snapshot);

/// Occupied voxels as rows of a sensor_msgs/PointCloud2, little-endian: x, y, z of the centre [m] and rgb as
/// float32 (bits 0x00rrggbb, as PCL and RViz read them), label as uint32.
struct MapPoints {
  static constexpr std::uint32_t kRowBytes = 20;
  std::uint32_t count = 0;
  std::vector<std::uint8_t> rows;
};
/// @param tree  of the snapshot's nodes.
MapPoints points_of(const octomap::ColorOcTree& tree, const MapSnapshot& snapshot);

/// All voxels as a delta from revision 0.
/// @param tree  of the snapshot's nodes. @param head  without arrays: what it says of map, revision,
/// keyframe.
MapDelta whole_map(const octomap::ColorOcTree& tree, const MapSnapshot& snapshot, const MapDelta& head);

/// What MapInfo says of the tree.
struct MapExtent {
  std::uint64_t occupied = 0;                     // voxels
  Eigen::Vector3d min = Eigen::Vector3d::Zero();  // of all that is known, free or occupied [m]
  Eigen::Vector3d max = Eigen::Vector3d::Zero();
};
MapExtent extent_of(const SemanticOctree& octree);

}  // namespace rds::mapper
