// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "services/tracker/core/loops/loop_fusion.hpp"
#include "services/tracker/core/relocalization/relocalizer.hpp"

namespace rds::tracker {

using Sightings = std::vector<FoundKeyframe>;

/// Keyframes of the later map that show what the earlier one shows, by their ids.
/// @param map  of both, as unite() makes it.
Sightings find_later_in_earlier(SlamMap& map, const SlamMap& earlier, const PoseSettings& settings,
                                KeyframeId first_of_later);

/// The sighting that most others agree with, of those that points confirm and nothing contradicts.
/// @param searched  keyframes. @return or why there is none, in words that can follow "B ".
tl::expected<LoopMatch, std::string> choose_joint(const SlamMap& map, const Sightings& found,
                                                  std::size_t searched);

}  // namespace rds::tracker
