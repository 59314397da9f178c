// SPDX-License-Identifier: Apache-2.0
#include "common/map_file/saved_map.hpp"

#include <fmt/format.h>

namespace rds::map_file {
namespace fs = std::filesystem;
namespace {

tl::expected<Sections, std::string> read_service_files(const fs::path& folder) {
  Sections all;
  for (const std::string& service : {kTracker, kMapper, kLoopCloser}) {
    if (!fs::exists(service_file(folder, service))) continue;
    auto sections = read_map_file(service_file(folder, service));
    if (!sections) return sections;
    all.merge(*sections);
  }
  if (all.empty())
    return tl::unexpected(fmt::format("{}: holds no saved map, expected {}", folder.string(), kMapFile));
  return all;
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
  for (const std::string& service : {kTracker, kMapper, kLoopCloser})
    fs::remove(service_file(folder, service), ignored);
  return {};
}

tl::expected<Sections, std::string> read_saved_map(const fs::path& path) {
  std::error_code error;
  if (!fs::is_directory(path, error)) return read_map_file(path);
  return fs::exists(path / kMapFile) ? read_map_file(path / kMapFile) : read_service_files(path);
}

tl::expected<Sections, std::string> read_saved_map(const fs::path& path,
                                                   const std::vector<std::string>& needed) {
  auto sections = read_saved_map(path);
  if (!sections) return sections;
  for (const std::string& name : needed)
    if (!sections->contains(name))
      return tl::unexpected(fmt::format("{}: has no section '{}', expected a map that all services saved",
                                        path.string(), name));
  return sections;
}

}  // namespace rds::map_file
