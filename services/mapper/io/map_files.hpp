// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>

#include <octomap/ColorOcTree.h>
#include <tl/expected.hpp>

#include "common/geometry/keyframe_pose.hpp"
#include "common/map_file/byte_writer.hpp"
#include "common/map_file/regular_file.hpp"
#include "services/mapper/core/objects/map_object.hpp"
#include "services/mapper/core/octree/occupancy_grid.hpp"

namespace rds::mapper {

/// Each writer writes beside the target and renames: a reader never sees half a file.
/// @return one sentence naming the file if it cannot be written.
using WriteResult = tl::expected<void, std::string>;

/// map.ot, as any OctoMap tool reads it.
WriteResult write_tree(const std::filesystem::path& file, const octomap::ColorOcTree& tree);

/// Reads map.ot, or a .bt file of OctoMap. What is neither, is cut off, or has bytes behind its end is
/// refused.
/// @return one sentence naming the file and what was expected.
tl::expected<std::unique_ptr<octomap::ColorOcTree>, std::string> read_tree(
    const std::filesystem::path& file, const map_file::FileLimits& limits = {});

/// True if the file starts as OctoMap's .ot and .bt files do.
bool looks_like_tree(const std::filesystem::path& file);
/// True for .bt alone: occupied or free, no more.
bool looks_like_binary_tree(const std::filesystem::path& file);

inline const std::string kTreeFile = "map.ot";

/// What lies beside map.rds for other programs, by name: map.ot, objects.json, grid.pgm and grid.yaml.
std::map<std::string, map_file::Bytes> files_for_others(const octomap::ColorOcTree& tree,
                                                        std::span<const MapObject> objects,
                                                        const OccupancyGrid& grid);

/// objects.json.
WriteResult write_objects(const std::filesystem::path& file, std::span<const MapObject> objects);

/// grid.pgm and grid.yaml for map_server, in `folder`.
WriteResult write_grid(const std::filesystem::path& folder, const OccupancyGrid& grid);

/// keyframes.txt: TUM format, map_from_camera.
WriteResult write_keyframes(const std::filesystem::path& file, std::span<const geometry::KeyframePose> poses);

}  // namespace rds::mapper
