// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <tl/expected.hpp>

namespace rds::evaluation {

/// In how many depth pictures a point is on a surface, and in how many before one.
struct PointViews {
  std::uint32_t on_surface = 0;
  std::uint32_t seen_through = 0;
};

/// Which depth pictures are looked at, and how far off a surface a point may be.
struct DepthViewsOptions {
  int every = 5;              // pictures between two that are looked at
  double tolerance_m = 0.05;  // a voxel
};

/// What the depth pictures of a recording show of points [m, in the frame of groundtruth.txt], from their
/// true poses; depths of 0.4 … 4 m count.
/// @return for each point, or one sentence that names what cannot be read.
tl::expected<std::vector<PointViews>, std::string> look_at(std::span<const Eigen::Vector3d> points,
                                                           const std::filesystem::path& recording,
                                                           const DepthViewsOptions& options);

}  // namespace rds::evaluation
