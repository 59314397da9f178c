// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/tracker/core/submaps/submap_joining.hpp"

namespace rds::tracker {

/// Measurements of one submap where keyframes of the other look, at a move.
struct SubmapFit {
  int agree = 0;       // depth was measured there as it should be
  int contradict = 0;  // … but was larger: the measured point would stand in a space that was seen to be free
};

/// Compares what the keyframes of both submaps measured at their features, if the one moves into the other.
/// Places that look alike do so from near; what is around them does not. What is farther than it was seen
/// from elsewhere may be hidden there and says nothing.
SubmapFit fit_of(const SlamMap& map, const SubmapMove& move);
/// Whether next to nothing contradicts the move, or little more than either submap contradicts itself by.
bool fits(const SlamMap& map, const SubmapMove& move);

}  // namespace rds::tracker
