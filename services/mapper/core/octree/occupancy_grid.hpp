// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <octomap/ColorOcTree.h>

#include "common/geometry/pose.hpp"
#include "services/mapper/core/config/mapper_config.hpp"

namespace rds::mapper {

/// 2-D projection for planners, laid out as nav_msgs/OccupancyGrid: row by row from the origin, x fastest.
struct OccupancyGrid {
  static constexpr std::int8_t kUnknown = -1;
  static constexpr std::int8_t kFree = 0;
  static constexpr std::int8_t kOccupied = 100;

  int width = 0;          // cells along the grid's x
  int height = 0;         // cells along the grid's y
  double resolution = 0;  // [m]
  geometry::Pose map_from_grid =
      geometry::Pose::Identity();  // corner of cell (0, 0); z points up, at floor height
  std::vector<std::int8_t> data;

  [[nodiscard]] std::int8_t at(int x, int y) const { return data[static_cast<std::size_t>(y * width + x)]; }
};

/// Looks at the map from above, in the height band of the configuration.
///
/// A cell is occupied if enough occupied voxels of the band lie over it, else free if a free one does, else
/// unknown. The floor is the lowest height at which occupied voxels pile up, unless configured. The grid's x
/// is the map's x (or z, if x is upright) laid level.
/// @param up_in_map  unit vector.
OccupancyGrid make_grid(const octomap::ColorOcTree& tree, const Eigen::Vector3d& up_in_map,
                        const GridConfig& config);

/// Rotation map_from_grid for a direction that points up.
Eigen::Matrix3d level_frame(const Eigen::Vector3d& up_in_map);

/// Height of the floor along `up` [m]; 0 for a map without occupied voxels.
double floor_height(const octomap::ColorOcTree& tree, const Eigen::Vector3d& up_in_map);

/// The picture of map_server: binary PGM, 254 free, 0 occupied, 205 unknown, first row = largest y.
std::string to_pgm(const OccupancyGrid& grid);

/// The YAML beside it. map_server knows a yaw only: origin is (x, y, 0) in the level frame.
std::string to_map_server_yaml(const OccupancyGrid& grid, const std::string& image_name);

}  // namespace rds::mapper
