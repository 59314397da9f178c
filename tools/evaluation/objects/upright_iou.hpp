// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/oriented_box.hpp"

namespace rds::evaluation {

/// Intersection over union of two boxes whose z axes are up: that of their rectangles seen from above, times
/// the common height. A tilt of a box's z axis is not looked at. 0 for boxes without volume.
double upright_iou(const geometry::OrientedBox& a, const geometry::OrientedBox& b);

}  // namespace rds::evaluation
