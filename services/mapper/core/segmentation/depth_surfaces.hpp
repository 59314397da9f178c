// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/mapper/core/keyframe/keyframe_record.hpp"

namespace rds::mapper {

/// Surfaces of a keyframe: parts of the static pixels whose neighbours are near each other in depth.
///
/// @param surface  of each pixel, from 1; 0 for pixels that are not static and in parts of a few pixels.
/// @return the number of surfaces.
std::uint16_t find_surfaces(const KeyframeRecord& record, const SamplingConfig& config,
                            std::vector<std::uint16_t>& surface);

}  // namespace rds::mapper
