// SPDX-License-Identifier: Apache-2.0
#include "common/map_file/saved_map.hpp"

#include <fmt/format.h>

namespace rds::map_file {
namespace fs = std::filesystem;
namespace {

tl::expected<Sections, std::string> with(tl::expected<Sections, std::string> sections,
                                         const std::vector<std::string>& needed, const fs::path& path) {
  if (!sections) return sections;
  for (const std::string& name : needed)
    if (!sections->contains(name))
      return tl::unexpected(fmt::format("{}: has no section '{}', expected a map that all services saved",
                                        path.string(), name));
  return sections;
}

}  // namespace

tl::expected<Sections, std::string> read_saved_map(const fs::path& path, const FileLimits& limits) {
  std::error_code error;
  if (!fs::is_directory(path, error)) return read_map_file(path, limits);
  if (fs::exists(path / kMapFile, error) || error) return read_map_file(path / kMapFile, limits);
  return tl::unexpected(fmt::format("{}: holds no saved map, expected {}", path.string(), kMapFile));
}

tl::expected<Sections, std::string> read_saved_map(const fs::path& path,
                                                   const std::vector<std::string>& needed,
                                                   const FileLimits& limits) {
  return with(read_saved_map(path, limits), needed, path);
}

tl::expected<Sections, std::string> read_saved_map(const Folder& map, const std::vector<std::string>& needed,
                                                   const FileLimits& limits) {
  const auto bytes = map.read(kMapFile, limits);
  if (!bytes) return tl::unexpected(bytes.error());
  auto sections = sections_from_bytes(*bytes);
  if (!sections)
    return tl::unexpected(fmt::format("{}: {}", (map.path() / kMapFile).string(), sections.error()));
  return with(std::move(sections), needed, map.path() / kMapFile);
}

}  // namespace rds::map_file
