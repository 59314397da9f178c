// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/saved_start.hpp"

#include <fmt/format.h>

#include "common/map_file/saved_map.hpp"
#include "services/mapper/io/map_files.hpp"
#include "services/mapper/io/octomap_file.hpp"

namespace rds::mapper {
namespace {

/// Makes a map of what was read; the sentence names the file.
struct ToMap {
  ReadMap operator()(const std::unique_ptr<octomap::ColorOcTree>& tree) const {
    return named(saved_map_from(std::move(*tree), config));
  }
  ReadMap operator()(const map_file::Sections& sections) const {
    return named(saved_map_from(sections.at(map_file::kMapper), config));
  }
  [[nodiscard]] ReadMap named(ReadMap map) const {
    if (map) return map;
    return tl::unexpected(fmt::format("{}: cannot be mapped on: {}", from.string(), map.error()));
  }

  const MapperConfig& config;
  std::filesystem::path from;
};

}  // namespace

ReadMap read_start(const std::filesystem::path& from, const map_file::FileLimits& limits,
                   const MapperConfig& config) {
  const ToMap to_map{config, from};
  if (looks_like_tree(from)) return read_tree(from, limits).and_then(to_map);
  return map_file::read_saved_map(from, {map_file::kMapper}, limits).and_then(to_map);
}

ReadMap read_start(const map_file::Folder& map, const map_file::FileLimits& limits,
                   const MapperConfig& config) {
  const ToMap to_map{config, map.path()};
  if (map.has_file(map_file::kMapFile) || !map.has_file(kTreeFile))
    return map_file::read_saved_map(map, {map_file::kMapper}, limits).and_then(to_map);
  return map.read(kTreeFile, limits)
      .and_then([](const auto& bytes) { return tree_from_octomap_file(bytes); })
      .and_then(to_map);
}

}  // namespace rds::mapper
