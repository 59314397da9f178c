// SPDX-License-Identifier: Apache-2.0
#include <system_error>

#include <fmt/format.h>

#include "common/map_file/folder.hpp"
#include "tools/rds/map/map_merge.hpp"

namespace rds::tools {
namespace fs = std::filesystem;
namespace {

using Written = tl::expected<void, std::string>;

Written write_all(const MapMerge& merge, const fs::path& folder) {
  const auto place = map_file::Folder::open(folder);
  if (!place) return tl::unexpected(place.error());
  for (const auto& [name, bytes] : merge.files)
    if (auto written = place->write(name, bytes, {}); !written) return written;
  if (auto written = geometry::write_trajectory(folder / "keyframes.txt", merge.keyframes); !written)
    return written;
  auto written = place->write(map_file::kMapFile, map_file::to_bytes(merge.sections), {});
  place->sync();
  return written;
}

}  // namespace

Written write_map(const MapMerge& merge, const fs::path& folder) {
  const fs::path target = folder.has_filename() ? folder : folder.parent_path();
  const fs::path unfinished = target.parent_path() / ("." + target.filename().string() + ".merging");
  std::error_code error;
  if (fs::exists(target, error))
    return tl::unexpected(fmt::format("{}: is there already, expected a new folder", target.string()));
  fs::remove_all(unfinished, error);  // of a merge that was stopped
  if (!fs::create_directories(unfinished, error))
    return tl::unexpected(fmt::format("{}: cannot be made: {}", unfinished.string(), error.message()));
  auto written = write_all(merge, unfinished);
  if (written) {
    fs::rename(unfinished, target, error);
    if (error)
      written = tl::unexpected(fmt::format("{}: cannot be written: {}", target.string(), error.message()));
  }
  if (!written) fs::remove_all(unfinished, error);
  return written;
}

}  // namespace rds::tools
