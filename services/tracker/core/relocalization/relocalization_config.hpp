// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace rds::tracker {

/// Recovery of a lost camera.
struct RelocalizationConfig {
  int candidates = 4;    // keyframes tried per frame
  int min_matches = 15;  // by appearance
  int min_inliers = 50;  // after widening the search
  int ransac_iterations = 200;
  bool operator==(const RelocalizationConfig&) const = default;
};

}  // namespace rds::tracker
