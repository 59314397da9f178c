// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/mapper/core/evidence/scene_history.hpp"
#include "services/mapper/core/segmentation/dynamic_masks.hpp"

namespace rds::mapper {

// The class of a pixel is decided here and nowhere else. Rules 1 to 3 look at the depth picture, 4 to 8 at
// objects, 9 to 11 at what other keyframes have seen. Among 4 to 7 the first that applies decides.
//
//  1. A pixel without depth is invalid; where all pixels around it have none, either, it is a no-return.
//  2. A pixel nearer than min_range_m, or whose depth too few neighbours share (a flying pixel), is invalid.
//  3. A pixel measured up to max_range_m is static, a farther one far.
//  4. A pixel on a plane that goes on outside of all boxes of movable objects is static.
//  5. A static pixel in the depth cut of a movable object is dynamic.
//  6. A static pixel beside such a cut (rim, small parts of the cut) is unknown, any other there invalid.
//  7. The same holds in a cell of the picture in which the tracker found motion.
//  8. A pixel is unconfirmed if it is unknown, or static and near something dynamic; not by rule 4.
//  9. An unconfirmed pixel is static if its connected surface was seen as static at another time, else
//  invalid.
// 10. What is still unknown is invalid.
// 11. A static pixel on a surface that is mostly transient is invalid.

/// Rules 1 to 3: sets the record's classes from its depth alone.
void classify_by_depth(KeyframeRecord& record, const SamplingConfig& config);

/// Rules 4 to 8: sets classes and unconfirmed pixels. @param record  with classes by depth. @param masks  of
/// its boxes.
void classify(KeyframeRecord& record, const DynamicMasks& masks, const MapperConfig& config);

/// Rules 9 to 11. @param record  classified. @param history  of all keyframes, this one included.
/// @return classes of which none is unknown.
PixelClasses resolve(const KeyframeRecord& record, const SceneHistory& history, const MapperConfig& config);

}  // namespace rds::mapper
