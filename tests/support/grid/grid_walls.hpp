// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace rds::test {

/// Of the points of walls that depth pictures show where a run's keyframes are, the share that lies over an
/// occupied cell of its grid, as planners look points up: by x and y alone. NaN if there are none.
///
/// @param dataset  depth of a room without people, by the same camera. @param out  of rds run.
double walls_over_occupied(const std::filesystem::path& dataset, const std::filesystem::path& out);

}  // namespace rds::test
