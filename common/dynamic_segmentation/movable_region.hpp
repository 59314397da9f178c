// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/box.hpp"

namespace rds::segmentation {

/// A part of the picture where something that can move is expected: features inside the box whose depth lies
/// in the interval, or that have no depth, are not to be trusted.
struct MovableRegion {
  geometry::Box2 box_px;  // in the picture as the camera gives it (with distortion)
  float min_depth_m = 0;
  float max_depth_m = 0;
  float sigma_m = 0.25F;  // standard deviation of its surface in depth, from its middle: a person's
};

}  // namespace rds::segmentation
