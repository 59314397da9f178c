// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "services/loop_closer/core/loop_types.hpp"

namespace rds::bench {

struct RecordedKeyframes {
  std::vector<loop_closer::KeyframeFeatures> keyframes;  // at their true poses, ids from 0, nothing covisible
  std::vector<geometry::Pose> truth;                     // map_from_camera
};

/// Every n-th frame of a recording with OpenCV's ORB features, their depth and the true pose.
///
/// @return or one sentence that says what is missing.
tl::expected<RecordedKeyframes, std::string> read_keyframes(const std::filesystem::path& folder,
                                                            std::size_t every);

/// The true poses with a drift that grows: per metre `drift_share` along a fixed direction and `turn_rad`
/// about the vertical axis, plus noise (fixed seed).
std::vector<geometry::Pose> drifted(const std::vector<geometry::Pose>& truth, double drift_share,
                                    double turn_rad);

}  // namespace rds::bench
