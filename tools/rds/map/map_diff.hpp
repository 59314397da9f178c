// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <octomap/ColorOcTree.h>

#include "tools/rds/map/map_export.hpp"

namespace rds::tools {

enum class VoxelState : std::uint8_t { kUnknown, kFree, kOccupied };

/// One of two maps to compare. Labels are told from colours by the label table; none without it.
struct ComparedMap {
  const octomap::ColorOcTree& tree;
  std::span<const std::string> labels;
};

/// What differs between the maps A and B, voxel by voxel at the finest level.
struct MapDifference {
  std::array<std::array<std::uint64_t, 3>, 3> voxels{};  // by state in A, state in B
  std::uint64_t other_value = 0;                         // same state, other log-odds
  std::uint64_t other_color = 0;                         // occupied in both
  std::map<std::pair<std::string, std::string>, std::uint64_t>
      relabelled;              // occupied in both: label in A, in B
  Eigen::AlignedBox3d bounds;  // of voxels with another state or label [m]

  [[nodiscard]] std::uint64_t count(VoxelState in_a, VoxelState in_b) const {
    return voxels[static_cast<std::size_t>(in_a)][static_cast<std::size_t>(in_b)];
  }
  /// True if no voxel has another state.
  [[nodiscard]] bool has_same_states() const;
  /// True if the maps are equal, value by value, colour by colour, label by label.
  [[nodiscard]] bool is_equal() const;
};

/// @pre both of one resolution.
/// @param points  what is occupied in either is appended unless nullptr: only in A red, only in B green, with
/// another label blue, the rest grey.
MapDifference compare_maps(const ComparedMap& a, const ComparedMap& b, std::vector<ColoredPoint>* points);

/// The difference in words and figures, several lines.
std::string describe(const MapDifference& difference, bool states_only);

}  // namespace rds::tools
