// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/loop_match.hpp"

namespace rds::tracker {

/// A keyframe that was found in another submap.
struct FoundKeyframe {
  geometry::LoopMatch match;
  int inliers = 0;        // map points that agree
  bool by_votes = false;  // of what looks alike (find_around_loss()); else by features that match for certain
};

}  // namespace rds::tracker
