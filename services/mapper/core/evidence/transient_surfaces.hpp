// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "services/mapper/core/evidence/scene_history.hpp"

namespace rds::mapper {

/// Static pixels on connected surfaces that are transient (SceneHistory) for at least `transient_share` of
/// their pixels: a person whom this keyframe's detector missed and others found. Pixels with the label of a
/// static object are not counted as transient.
///
/// @param classes  of each pixel, none unknown.
/// @return per pixel; empty if there are none.
std::vector<bool> transient_pixels(const KeyframeRecord& record, const SceneHistory& history,
                                   const MapperConfig& config, const PixelClasses& classes);

}  // namespace rds::mapper
