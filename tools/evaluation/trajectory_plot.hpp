// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include <opencv2/core.hpp>
#include <tl/expected.hpp>

#include "common/geometry/trajectory.hpp"

namespace rds::evaluation {

/// What a plot shows: an estimated path and, if there is one, the true path.
struct TrajectoryPlotInput {
  std::span<const geometry::StampedPose> truth;  // may be empty
  std::span<const geometry::StampedPose> estimate;
  std::string title;  // ASCII
};

/// Draws the path in the plane of its two largest extents, and beside it the error over time (with truth,
/// after alignment) or the position over time (without). A gap of more than half a second breaks the line.
///
/// @return CV_8UC3, 1240×660 px.
cv::Mat draw_trajectory_plot(const TrajectoryPlotInput& input);

/// Draws into a PNG file. @return or one sentence that names the file.
tl::expected<void, std::string> write_trajectory_plot(const std::filesystem::path& file,
                                                      const TrajectoryPlotInput& input);

}  // namespace rds::evaluation
