// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include <Eigen/Core>

#include "common/geometry/box.hpp"
#include "common/geometry/camera_model.hpp"
#include "common/geometry/oriented_box.hpp"
#include "common/dynamic_segmentation/object_region.hpp"

namespace rds::tracker::prediction {

/// Sides of an image box at which the picture's edge cuts the object off: it goes on there, unseen.
struct CutSides {
  bool left = false;
  bool top = false;
  bool right = false;
  bool bottom = false;
};

/// An object that was detected in a key frame, in the map.
struct ObjectObservation {
  geometry::OrientedBox box;  // aligned with the camera of the key frame; see OrientedBox
  std::string label;
  float score = 0;
  CutSides cut = {};  // set by ObjectPredictor
};

/// What the camera of a key frame could see.
struct KeyframeView {
  geometry::Pose map_from_camera = geometry::Pose::Identity();
  geometry::CameraModel camera;
};

/// Where an object is expected at the time that predict() was asked for.
struct PredictedObject {
  std::uint64_t id = 0;  // from 1, never used again
  std::string label;
  float score = 0;  // of the latest detection
  bool movable = false;
  geometry::OrientedBox box;  // orientation of the latest detection, grown by the uncertainty
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  // [m/s], map frame
  double covariance_trace = 0;                         // of the centre [m²]
  double age_s = 0;                                    // since the latest detection
};

/// A predicted object in the picture of one frame.
struct PredictedBox {
  geometry::Box2 box;                  // clipped to the picture [px]
  segmentation::ObjectRegion region;  // the box with its margin, and depths that may belong to the object
};

}  // namespace rds::tracker::prediction
