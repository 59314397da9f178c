// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/box.hpp"
#include "common/image/rgbd_frame.hpp"

namespace rds::detector {

/// Depth of the object in a box: of its own surface, not of the wall that the box also shows.
///
/// The valid depths in the central part of the box are divided into surfaces (the fullest interval of half a
/// metre, then nearer ones that are nearly as full); the result is the mean of the median and the 1/3
/// quantile of the chosen one.
/// @param box  [px]; what lies outside the picture is ignored.
/// @param max_depth_m  what is further away counts as no measurement.
/// @return [m]; 0 if too few pixels have a depth.
/// Source: NGD-SLAM (Zhang et al. 2025) for mean(median, 1/3 quantile). Deviation: only over the object's
/// surface.
[[nodiscard]] float box_depth(const image::DepthImage& depth, const geometry::Box2& box, double max_depth_m);

}  // namespace rds::detector
