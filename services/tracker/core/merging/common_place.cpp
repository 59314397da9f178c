// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/merging/common_place.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "services/tracker/core/submaps/submap_fit.hpp"

namespace rds::tracker {
namespace {

/// How many sightings agree with each.
std::vector<std::size_t> agreements(const SlamMap& map, const Sightings& found) {
  std::vector<std::size_t> counts;
  for (const FoundKeyframe& a : found)
    counts.push_back(static_cast<std::size_t>(
        std::ranges::count_if(found, [&](const FoundKeyframe& b) { return agree(map, a.match, b.match); })));
  return counts;
}

}  // namespace

Sightings find_later_in_earlier(SlamMap& map, const SlamMap& earlier, const PoseSettings& settings,
                                KeyframeId first_of_later) {
  Relocalizer relocalizer;
  relocalizer.index_all(earlier);
  std::vector<KeyframeId> later;
  std::as_const(map).keyframes().for_each([&](const Keyframe& k) { later.push_back(k.id); }, first_of_later);
  Sightings found;
  for (const KeyframeId id : later)
    if (auto seen = relocalizer.find_in_others(map, settings, id)) found.push_back(*seen);
  return found;
}

tl::expected<LoopMatch, std::string> choose_joint(const SlamMap& map, const Sightings& found,
                                                  std::size_t searched) {
  std::vector<std::size_t> agreeing = agreements(map, found);
  bool is_contradicted = false;
  while (!agreeing.empty()) {
    const auto best = std::ranges::max_element(agreeing);  // the first of equal ones
    if (*best < kAgreeingSightings) break;
    const LoopMatch& match = found[static_cast<std::size_t>(best - agreeing.begin())].match;
    const bool is_confirmed = std::ranges::any_of(found, [&](const FoundKeyframe& f) {
      return agree(map, match, f.match) && confirms_of_merged_maps(map, f.match);
    });
    if (is_confirmed && fits(map, move_of(map, match))) return match;
    is_contradicted = true;
    for (std::size_t i = 0; i < found.size(); ++i)
      if (agree(map, match, found[i].match)) agreeing[i] = 0;
  }
  if (is_contradicted)
    return tl::unexpected<std::string>(
        "shows places of it, but what both measured there contradicts each other");
  return tl::unexpected(fmt::format(
      "{} of its {} keyframes were found, expected {} that agree on how the maps lie to each other",
      found.size(), searched, kAgreeingSightings));
}

}  // namespace rds::tracker
