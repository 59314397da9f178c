// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <octomap/ColorOcTree.h>
#include <tl/expected.hpp>

namespace rds::tools {

struct ColoredPoint {
  Eigen::Vector3f center = Eigen::Vector3f::Zero();  // [m]
  std::array<std::uint8_t, 3> rgb{};
};
/// A binary PLY file.
std::string to_ply(std::span<const ColoredPoint> points, const std::string& comment);

/// Formats a map can be written in: ot (OctoMap with colours and probabilities), bt (OctoMap, occupied or
/// free only), ply and pcd (centres of occupied voxels with colour), pgm (2-D grid of map_server, with its
/// YAML beside it).
inline constexpr const char* kMapFormats[] = {"ot", "bt", "ply", "pcd", "pgm"};

/// The format a file's ending names; empty if none of kMapFormats.
std::string format_of(const std::filesystem::path& file);

/// Writes the map, whole or not at all.
///
/// @param up  for pgm: axis of the map frame that points up, "x", "-x", … "-z".
/// @return or one sentence that names the file.
tl::expected<void, std::string> export_map(const octomap::ColorOcTree& tree, const std::string& format,
                                           const std::filesystem::path& file, const std::string& up);

/// type, resolution [m], nodes, leaves, occupied and free voxels, occupied volume [m³], bounds of what is
/// occupied [m].
nlohmann::ordered_json describe_map(const octomap::ColorOcTree& tree);

/// state (occupied, free, unknown) at a point of the map frame [m]; probability and colour where known; label
/// if one of `labels` has that colour.
nlohmann::ordered_json query_map(const octomap::ColorOcTree& tree, const Eigen::Vector3d& point,
                                 std::span<const std::string> labels);

}  // namespace rds::tools
