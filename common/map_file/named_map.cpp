// SPDX-License-Identifier: Apache-2.0
#include "common/map_file/named_map.hpp"

#include <algorithm>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include "common/map_file/saved_map.hpp"

namespace rds::map_file {
namespace {

constexpr std::size_t kMaxName = 64;
constexpr std::string_view kTaken = "checkpoints";  // of the live map

bool is_of_names(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '_' ||
         c == '-';
}

std::vector<std::string> parts_of(const Folder& map) {
  std::vector<std::string> parts;
  const auto bytes = map.read(kMapFile, {});
  const auto sections = bytes ? sections_from_bytes(*bytes) : tl::unexpected(bytes.error());
  for (const std::string& part : kParts)
    if (sections && sections->contains(part)) parts.push_back(part);
  return parts;
}

MapSummary summary_of(const std::string& name, const Folder& map) {
  MapSummary summary{.name = name, .parts = parts_of(map)};
  for (const std::string& file : map.names()) {
    struct stat about {};
    if (fstatat(map.number(), file.c_str(), &about, AT_SYMLINK_NOFOLLOW) != 0) continue;
    summary.bytes += static_cast<std::uint64_t>(about.st_size);
    if (file == kMapFile) summary.saved_s = about.st_mtim.tv_sec;
  }
  return summary;
}

}  // namespace

tl::expected<void, std::string> check_map_name(std::string_view name) {
  const bool possible = !name.empty() && name.size() <= kMaxName && name.front() != '.' && name != kTaken &&
                        std::ranges::all_of(name, is_of_names);
  if (possible) return {};
  return tl::unexpected(fmt::format(
      "not the name of a map, expected 1 to {} of A-Z a-z 0-9 . _ - without a leading dot, and not '{}'",
      kMaxName, kTaken));
}

tl::expected<Folder, std::string> open_map(const std::filesystem::path& maps, const std::string& name) {
  if (const auto checked = check_map_name(name); !checked) return tl::unexpected(checked.error());
  const auto folder = Folder::open(maps);
  return folder ? folder->enter(name) : tl::unexpected(folder.error());
}

tl::expected<std::vector<MapSummary>, std::string> list_maps(const std::filesystem::path& maps) {
  const auto folder = Folder::open(maps);
  if (!folder) return tl::unexpected(folder.error());
  std::vector<MapSummary> all;
  for (const std::string& name : folder->names()) {
    if (!check_map_name(name)) continue;
    const auto map = folder->enter(name);
    if (map && map->has_file(kMapFile)) all.push_back(summary_of(name, *map));
  }
  return all;
}

}  // namespace rds::map_file
