// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <tl/expected.hpp>

#include "services/tracker/core/map/slam_map.hpp"

namespace rds::tracker {

/// The map of these contents, whose keyframes need no `points`. @return or what does not fit together: a
/// point that no or an unknown keyframe sees, a feature with two points, a pose whose chain of anchors does
/// not end at a keyframe of the map.
tl::expected<SlamMap, std::string> map_of(MapContents&& contents, const ScalePyramid& pyramid);

}  // namespace rds::tracker
