// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <tl/expected.hpp>

namespace rds::evaluation {

/// A leaf of an octree with 16 levels; it spans 2^`height` voxels a side from `key` on.
struct OctreeLeaf {
  std::array<std::uint16_t, 3> key{};  // of its lowest corner voxel; 32768 is the voxel that starts at 0 m
  int height = 0;
  float log_odds = 0;
  std::array<std::uint8_t, 3> color{};  // red, green, blue; of a ColorOcTree
};

struct OctreeFile {
  std::string type;  // "OcTree" or "ColorOcTree"
  double resolution_m = 0;
  std::size_t nodes = 0;  // inner ones included
  std::vector<OctreeLeaf> leaves;

  /// Centres [m] of all voxels inside leaves with log-odds > 0, in the map's frame.
  [[nodiscard]] std::vector<Eigen::Vector3d> occupied_centers() const;
  /// Colours of the same voxels.
  [[nodiscard]] std::vector<std::array<std::uint8_t, 3>> occupied_colors() const;
};

/// Reads an OctoMap `.ot` file (OcTree, ColorOcTree) byte by byte, so that a torn or hostile file ends in an
/// error where OctoMap's own reader would read on beyond its end.
///
/// @return or one sentence that names the file: unreadable, no such tree, torn, with an occupied leaf above
/// 64 voxels.
tl::expected<OctreeFile, std::string> read_octree_file(const std::filesystem::path& file);

}  // namespace rds::evaluation
