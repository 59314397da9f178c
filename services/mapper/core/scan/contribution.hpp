// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/mapper/core/evidence/keyframe_view.hpp"
#include "services/mapper/core/scan/scan.hpp"

namespace rds::mapper {

/// What a keyframe contributes to the map with the pose it has.
/// @param record  classified. @param scan  scratch memory.
KeyframeView contribution_of(const KeyframeRecord& record, const OctreeConfig& octree,
                             const SamplingConfig& sampling, Scan& scan);

}  // namespace rds::mapper
