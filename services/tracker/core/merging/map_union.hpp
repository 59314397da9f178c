// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tl/expected.hpp>

#include "services/tracker/core/map/map_contents.hpp"

namespace rds::tracker {

/// Two maps in one: the earlier one as the map, all its keyframes fixed, the later one beside it as a submap,
/// as it stood in its own frame. Ids of the later map's keyframes and points count on behind those of the
/// earlier one; poses of its culled keyframes are relative to the kept one before them, so that they move
/// with it.
/// @pre both are of one image pyramid, and the later one holds its keyframe 0, as saved maps do.
/// @return or why not, as map_of().
tl::expected<SlamMap, std::string> unite(const SlamMap& earlier, const SlamMap& later);

/// The submap that the later map is in unite()'s result.
inline constexpr SubmapId kLaterMap = 1;

}  // namespace rds::tracker
