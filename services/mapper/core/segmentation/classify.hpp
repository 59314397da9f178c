// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/mapper/core/segmentation/dynamic_masks.hpp"

namespace rds::mapper {

// The class of a pixel is decided here and nowhere else, by what its own keyframe shows. Rules 1 to 3 look at
// the depth picture, 4 to 7 at objects. Among 4 to 6 the first that applies decides.
//
//  1. A pixel without depth is invalid; where all pixels around it have none, either, it is a no-return.
//  2. A pixel nearer than min_range_m, or whose depth too few neighbours share (a flying pixel), is invalid.
//  3. A pixel measured up to max_range_m is static, a farther one far.
//  4. A static pixel that shows a movable object is dynamic.
//  5. A static pixel beside one (rim, another depth in the same cell) is unknown, any other there invalid.
//  6. The same holds in a cell of the picture in which the tracker found motion.
//  7. A pixel that is static by rule 3 and near something dynamic is doubtful, unless it lies on a plane that
//     goes on outside of all boxes of movable objects.
// What an unknown or doubtful one counts is decided where all keyframes come together:
// evidence/occupancy_model.hpp.

/// Rules 1 to 3: sets the record's classes from its depth alone.
void classify_by_depth(KeyframeRecord& record, const SamplingConfig& config);

/// Rules 4 to 7. @param record  with classes by depth. @param by_boxes  segment_dynamic() of it.
void classify(KeyframeRecord& record, std::span<const ByBoxes> by_boxes, const MapperConfig& config);

}  // namespace rds::mapper
