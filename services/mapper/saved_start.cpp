// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/saved_start.hpp"

#include <fmt/format.h>

#include "common/map_file/saved_map.hpp"
#include "services/mapper/io/map_files.hpp"
#include "services/mapper/io/octomap_file.hpp"

namespace rds::mapper {
namespace {

using Tree = tl::expected<std::unique_ptr<octomap::ColorOcTree>, std::string>;
using Sections = tl::expected<map_file::Sections, std::string>;

/// A saved map that fits, or one sentence naming the file.
tl::expected<SavedMap, std::string> named(tl::expected<SavedMap, std::string> saved,
                                          const std::filesystem::path& from) {
  if (saved) return saved;
  return tl::unexpected(fmt::format("{}: cannot be mapped on: {}", from.string(), saved.error()));
}

tl::expected<SavedMap, std::string> start_from(const Tree& tree, const MapperConfig& config,
                                               const std::filesystem::path& from) {
  if (!tree) return tl::unexpected(tree.error());
  return named(saved_map_from(std::move(**tree), config), from);
}

tl::expected<SavedMap, std::string> start_from(const Sections& sections, const MapperConfig& config,
                                               const std::filesystem::path& from) {
  if (!sections) return tl::unexpected(sections.error());
  return named(saved_map_from(sections->at(map_file::kMapper), config), from);
}

}  // namespace

tl::expected<SavedMap, std::string> read_start(const std::filesystem::path& from,
                                               const map_file::FileLimits& limits,
                                               const MapperConfig& config) {
  if (looks_like_tree(from)) return start_from(read_tree(from, limits), config, from);
  return start_from(map_file::read_saved_map(from, {map_file::kMapper}, limits), config, from);
}

tl::expected<SavedMap, std::string> read_start(const map_file::Folder& map,
                                               const map_file::FileLimits& limits,
                                               const MapperConfig& config) {
  if (map.has_file(map_file::kMapFile) || !map.has_file(kTreeFile))
    return start_from(map_file::read_saved_map(map, {map_file::kMapper}, limits), config, map.path());
  const auto bytes = map.read(kTreeFile, limits);
  return start_from(bytes ? tree_from_octomap_file(*bytes) : tl::unexpected(bytes.error()), config, map.path());
}

}  // namespace rds::mapper
