// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "services/mapper/core/evidence/scene_history.hpp"

namespace rds::mapper {

/// Takes surfaces out of use that are mostly where SceneHistory::is_passing(): somebody whom this keyframe
/// does not know, but others do; not those of a static object that it has found. They are neither inserted
/// nor do they carve.
///
/// @param use  of each pixel, as confirmed_use() gives it.
void leave_out_passing(const KeyframeRecord& record, const SceneHistory& history, const MapperConfig& config,
                       std::vector<PixelUse>& use);

}  // namespace rds::mapper
