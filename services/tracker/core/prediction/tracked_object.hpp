// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include <Eigen/Core>

#include "common/geometry/box.hpp"
#include "common/geometry/oriented_box.hpp"
#include "services/tracker/core/prediction/movable_region.hpp"

namespace rds::tracker::prediction {

/// An object that was detected in a key frame, in the map.
struct ObjectObservation {
  geometry::OrientedBox box;  // aligned with the camera of the key frame; see OrientedBox
  std::string label;
  float score = 0;
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
  geometry::Box2 box;    // clipped to the picture [px]
  MovableRegion region;  // the box with its margin, and the depths that may belong to the object
};

}  // namespace rds::tracker::prediction
