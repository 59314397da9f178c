// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "services/mapper/core/evidence/surface_history.hpp"

namespace rds::mapper {

/// Finds the pixels near something movable and the surfaces they belong to: they may be legs, an arm or a bag
/// that is in no box. Background is beyond doubt. Fills `record.doubt`; empty where nothing movable is in
/// view.
void mark_doubtful(KeyframeRecord& record, const MapperConfig& config);

/// The use of each pixel when doubtful ones count only where most of their surface has been seen standing at
/// another time; the others are not used, neither to insert nor to carve.
///
/// A surface is what hangs together in the depth picture. It is judged as a whole, so that the end of a table
/// that nobody has seen before comes in with the rest of it. Large ones need less: walls and floors.
std::vector<PixelUse> confirmed_use(const KeyframeRecord& record, const SurfaceHistory& history,
                                    const MapperConfig& config);

}  // namespace rds::mapper
