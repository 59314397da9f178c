// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "services/mapper/core/evidence/scene_history.hpp"

namespace rds::mapper {

/// Which surfaces of a record's unconfirmed pixels have been seen as static at another time, too: so long
/// before or after that something dynamic would have moved.
///
/// A surface is judged as a whole, so that the end of a table that no keyframe has seen before is confirmed
/// with the rest of it: at least 70 % of its pixels must lie in voxels seen apart_s earlier or later, or 15 %
/// if it fills a tenth of the picture, as walls and floors do.
/// @return per surface, from 1; empty where there are none.
std::vector<bool> confirmed_surfaces(const KeyframeRecord& record, const StaticHistory& history,
                                     const MapperConfig& config);

/// Static pixels on connected surfaces that are transient (SceneHistory) for at least `transient_share` of
/// their pixels: a person whom this keyframe's detector missed and others found. Pixels with the label of a
/// static object are not counted as transient.
///
/// @param classes  of each pixel, none unknown.
/// @return per pixel; empty if there are none.
std::vector<bool> transient_pixels(const KeyframeRecord& record, const SceneHistory& history,
                                   const MapperConfig& config, const PixelClasses& classes);

}  // namespace rds::mapper
