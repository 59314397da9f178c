// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/tracker/core/map/slam_map.hpp"

namespace rds::tracker {

/// Keyframes that must see a point without depth before it enters the map.
inline constexpr std::size_t kMinTriangulatingViews = 3;

/// True for a point that was made without depth, and that no keyframe has seen with depth since.
bool rests_on_views(const SlamMap& map, const MapPoint& point);

/// Erases such a point if the keyframes that still see it know it too badly: one was culled, or does not see
/// it any more.
void erase_if_unknown(SlamMap& map, PointId point);

}  // namespace rds::tracker
