// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/tracker/core/removal/depth_grid.hpp"

namespace rds::tracker {

/// Marks (255) planes that go on outside all suspect parts of a picture: a table, a wall, the floor.
///
/// @param suspect  not 0 where something movable may show; what is background already counts nevertheless.
/// @param background  all planes are marked here …
/// @param wide        … and those that are wider than a person here.
void mark_planes(const cv::Mat1f& depth_m, const GridGeometry& grid, const cv::Mat1b& suspect,
                 cv::Mat1b& background, cv::Mat1b& wide);

}  // namespace rds::tracker
