// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <octomap/ColorOcTree.h>
#include <opencv2/core.hpp>

#include "common/geometry/oriented_box.hpp"

namespace rds::tools {

/// Box of an object to draw, map frame [m].
struct SceneObject {
  std::string label;
  geometry::OrientedBox box;
};

/// What a picture of a map shows; everything in the map frame.
struct MapScene {
  const octomap::ColorOcTree& tree;
  std::vector<std::string> labels;  // names whose colours the legend explains, if they occur; "" is skipped
  std::vector<SceneObject> objects;
  std::vector<Eigen::Vector3d> trajectory;  // camera centres [m]
};

struct PictureOptions {
  int width = 1600;
  int height = 900;
  Eigen::Vector3d up = -Eigen::Vector3d::UnitY();  // against gravity, unit vector in the map frame
  double max_height_m = 2.4;                       // above the floor; what is higher would hide the room
  std::string title;                               // shown above; empty: the map's size in figures
};

/// Draws the map twice, at an angle and from above, with trajectory, object boxes, scale and legend. Software
/// only.
/// @return CV_8UC3 (BGR) of the size asked for; a note instead of voxels if the map is empty.
cv::Mat render_map(const MapScene& scene, const PictureOptions& options);

}  // namespace rds::tools
