// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/box.hpp"

namespace rds::segmentation {

/// A part of the picture where an object is expected, between these depths: something that can move, whose
/// features are not to be trusted, or, for the mapper, a static one that is cut out of its box.
struct ObjectRegion {
  geometry::Box2 box_px;  // in the picture as the camera gives it (with distortion)
  float min_depth_m = 0;
  float max_depth_m = 0;
  float sigma_m = 0.25F;  // standard deviation of its surface in depth, from its middle: a person's
};

}  // namespace rds::segmentation
