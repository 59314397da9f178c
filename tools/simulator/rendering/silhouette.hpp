// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "common/geometry/camera_model.hpp"
#include "common/geometry/pose.hpp"
#include "tools/simulator/rendering/mesh.hpp"

namespace rds::simulator {

/// Area in pixels [px²] of a mesh alone in an unbounded picture (up to 4000 px around the real one), within 2
/// %.
double silhouette_area(const Mesh& mesh, const geometry::CameraModel& camera,
                       const geometry::Pose& camera_from_world);

/// The visible part of one object.
struct VisiblePart {
  std::uint16_t object = 0;
  cv::Rect box;
  int area = 0;
  double depth_m = 0;  // median
};

/// Parts of all objects but 0, by ascending object number.
///
/// @param object  CV_16UC1, @param depth  CV_32FC1 of the same size.
std::vector<VisiblePart> visible_objects(const cv::Mat& object, const cv::Mat& depth);

}  // namespace rds::simulator
