// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>

#include <octomap/ColorOcTree.h>
#include <tl/expected.hpp>

#include "common/map_file/byte_writer.hpp"
#include "common/map_file/regular_file.hpp"
#include "services/mapper/core/objects/map_object.hpp"
#include "services/mapper/core/octree/occupancy_grid.hpp"

namespace rds::mapper {

/// Writes map.ot, as any OctoMap tool reads it, beside the target and renames: a reader never sees half a
/// file.
/// @return one sentence naming the file if it cannot be written.
tl::expected<void, std::string> write_tree(const std::filesystem::path& file,
                                           const octomap::ColorOcTree& tree);

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

/// The tree and the label table of a saved map, of any resolution; objects and votes are not read.
struct SavedTree {
  std::unique_ptr<octomap::ColorOcTree> tree;
  std::vector<std::string> labels;  // index 0 is ""
};

/// Reads both from the mapper's part of a saved map, as to_bytes() gives it.
/// @return or one sentence saying what is wrong with the bytes.
tl::expected<SavedTree, std::string> tree_from_map_bytes(std::span<const std::uint8_t> bytes);

}  // namespace rds::mapper
