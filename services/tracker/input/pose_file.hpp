// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "services/tracker/core/tracker.hpp"

namespace rds::tracker {

/// Poses of a TUM trajectory, interpolated between neighbours at most `max_gap_s` apart.
///
/// @return empty for an empty path: poses are to be estimated.
/// @throws std::runtime_error with one sentence that names the file, the line and what was expected.
GivenPoses read_given_poses(const std::filesystem::path& file, double max_gap_s);

}  // namespace rds::tracker
