// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/config_reader.hpp"
#include "common/geometry/box.hpp"
#include "common/image/rgbd_frame.hpp"

namespace rds::detector {

struct BoxDepthConfig {
  double central_part = 0.6;     // of the box's width and height, that is looked at
  double object_extent_m = 0.5;  // depths this near to each other belong to one surface
  double nearer_surface = 0.4;   // a nearer surface wins if it has this share of the largest surface's pixels
  double min_valid = 0.05;       // share of the pixels that must have a depth
  double max_depth_m = 20.0;     // what is further away counts as no measurement

  bool operator==(const BoxDepthConfig&) const = default;
};

void read(config::ConfigReader& reader, BoxDepthConfig& config);

/// Depth of the object in a box: of its own surface, not of the wall that the box also shows.
///
/// The valid depths in the central part of the box are divided into surfaces (the fullest interval of
/// object_extent_m, then nearer ones that are nearly as full); the result is the mean of the median and the
/// 1/3 quantile of the chosen one.
/// @param box  [px]; what lies outside the picture is ignored.
/// @return [m]; 0 if too few pixels have a depth.
/// Source: NGD-SLAM (Zhang et al. 2025) for mean(median, 1/3 quantile). Deviation: only over the object's
/// surface.
[[nodiscard]] float box_depth(const image::DepthImage& depth, const geometry::Box2& box,
                              const BoxDepthConfig& config = {});

}  // namespace rds::detector
