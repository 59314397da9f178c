// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "common/dynamic_segmentation/depth_grid.hpp"
#include "common/dynamic_segmentation/evidence_model.hpp"
#include "common/dynamic_segmentation/object_region.hpp"

namespace rds::segmentation {

/// Of each cell log(P(movable) / P(static)), by what boxes say of it: whether it is in one, and how far from
/// its object in depth. An object's depth is the median of what its box shows between its limits. Of several
/// boxes the one that says most counts.
/// @param depth_m  of the cells; 0 where nothing was measured: there only the box is known.
cv::Mat1f box_log_odds(const cv::Mat1f& depth_m, const GridGeometry& grid,
                       std::span<const ObjectRegion> boxes, const EvidenceModel& model);

/// The cells of a box, inside the picture.
cv::Rect cells_of(const geometry::Box2& box, const GridGeometry& grid);

}  // namespace rds::segmentation
