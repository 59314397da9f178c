// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/mapper/core/keyframe/keyframe_record.hpp"

namespace rds::mapper {

/// Surfaces of a keyframe: connected components of the static and unknown pixels; neighbours are connected if
/// their depths differ by no more than kSurfaceStepM × max(1, depth / 1 m).
///
/// @param surface  of each pixel, from 1; 0 for other classes and for components of fewer than 8 pixels.
/// @return the number of surfaces.
std::uint16_t find_surfaces(const KeyframeRecord& record, std::vector<std::uint16_t>& surface);

}  // namespace rds::mapper
