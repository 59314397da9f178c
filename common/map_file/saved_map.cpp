// SPDX-License-Identifier: Apache-2.0
#include "common/map_file/saved_map.hpp"

#include <fmt/format.h>

namespace rds::map_file {
namespace fs = std::filesystem;
namespace {

tl::expected<Sections, std::string> read_service_files(const fs::path& folder) {
  Sections all;
  for (const std::string& service : kParts) {
    std::error_code error;
    if (!fs::exists(service_file(folder, service), error)) continue;
    auto sections = read_map_file(service_file(folder, service));
    if (!sections) return sections;
    all.merge(*sections);
  }
  if (all.empty())
    return tl::unexpected(fmt::format("{}: holds no saved map, expected {}", folder.string(), kMapFile));
  return all;
}

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

fs::path service_file(const fs::path& folder, const std::string& service) {
  return folder / (service + ".rds");
}

tl::expected<void, std::string> merge_service_files(const fs::path& folder, const fs::path& target) {
  const auto sections = read_service_files(folder);
  if (!sections) return tl::unexpected(sections.error());
  if (auto written = write_map_file(target, *sections); !written) return written;
  std::error_code ignored;
  for (const std::string& service : kParts) fs::remove(service_file(folder, service), ignored);
  return {};
}

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
