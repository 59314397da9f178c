// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace rds::test {

/// Of the points of walls that depth pictures show, put where a run's trajectory has the camera at their
/// time, the share that lies over an occupied cell of its grid, as planners look points up: by x and y alone.
/// NaN if there are none.
///
/// @param dataset  depth of a room without people, by the same camera on the same path, at any rate.
/// @param out  of rds run.
double walls_over_occupied(const std::filesystem::path& dataset, const std::filesystem::path& out);

}  // namespace rds::test
