// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "services/tracker/core/movable_region.hpp"
#include "services/tracker/core/removal/depth_grid.hpp"
#include "services/tracker/core/removal/removal_config.hpp"

namespace rds::tracker {

/// Marks (255) in `mask` the objects in boxes, cut out by depth: of each box the surfaces within its depth
/// interval, and what they are connected with up to reach_m beyond the box. Planes that go on around the box
/// are not the object's: where they are, `background` becomes 255; where it is 255 already, nothing is cut.
///
/// Where nothing was measured a cell is the object's if its box is hardly measured at all.
void cut_boxes(const cv::Mat1f& depth_m, const GridGeometry& grid, std::span<const MovableRegion> regions,
               const cv::Mat1b& background, const RemovalConfig& config, cv::Mat1b& mask);

/// Marks in `background` planes that go on outside all boxes: a table, a wall, the floor.
///
/// @param wide  of these the ones that are wider than a person.
/// @param suspect  255 where else nothing is asked for planes.
void mark_planes(const cv::Mat1f& depth_m, const GridGeometry& grid, std::span<const MovableRegion> regions,
                 cv::Mat1b suspect, cv::Mat1b& background, cv::Mat1b& wide);

/// Marks cells that belong to something movable, and what they are connected with up to reach_m around them.
void cut_around(const cv::Mat1f& depth_m, const GridGeometry& grid, const std::vector<cv::Point>& cells,
                const cv::Mat1b& background, const RemovalConfig& config, cv::Mat1b& mask);

/// Marks whole boxes, whatever their depth.
void fill_boxes(const GridGeometry& grid, std::span<const MovableRegion> regions, cv::Mat1b& mask);

/// Marks cells without measurement most of whose measured neighbours are marked, then a rim of one cell
/// around all that is marked.
void close_and_widen(const cv::Mat1f& depth_m, cv::Mat1b& mask);

}  // namespace rds::tracker
