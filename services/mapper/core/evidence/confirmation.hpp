// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "services/mapper/core/evidence/static_history.hpp"

namespace rds::mapper {

/// Which of a record's doubtful surfaces have been seen as static at another time, too: so long before or
/// after that something dynamic would have moved.
///
/// A surface is judged as a whole, so that the end of a table that no keyframe has seen before is confirmed
/// with the rest of it: at least 70 % of its pixels must lie in voxels seen apart_s earlier or later, or 15 % if
/// it fills a tenth of the picture, as walls and floors do.
/// @return per surface, from 1; empty without doubt.
std::vector<bool> confirmed_surfaces(const KeyframeRecord& record, const StaticHistory& history,
                                     const MapperConfig& config);

}  // namespace rds::mapper
