// SPDX-License-Identifier: Apache-2.0
#include "common/store/maps_folder.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include <fmt/format.h>
#include <sys/stat.h>

namespace rds::store {
namespace fs = std::filesystem;
namespace {

/// A path from the environment; empty where it is not set, or not absolute, as XDG wants it.
fs::path path_of(const char* variable) {
  const char* value = std::getenv(variable);
  const fs::path path = value == nullptr ? "" : value;
  return path.is_absolute() ? path : fs::path();
}

}  // namespace

void read(config::ConfigReader& reader, MapsConfig& config) {
  reader.value("maps_dir", config.maps_dir);
  reader.value("max_map_mb", config.max_map_mb, std::uint64_t{1}, std::uint64_t{1'000'000}, "MB");
  reader.value("checkpoint", config.checkpoint);
  reader.value("checkpoint_s", config.checkpoint_s, 0.1, 3600.0, "s");
  reader.value("backup_s", config.backup_s, 0.0, 1e6, "s");
}

tl::expected<fs::path, std::string> maps_folder(const MapsConfig& config) {
  std::error_code error;
  if (!config.maps_dir.empty()) return fs::absolute(config.maps_dir, error).lexically_normal();
  if (const fs::path own = path_of("RDS_MAPS_DIR"); !own.empty()) return own;
  const fs::path below = fs::path("rds-slam") / "maps";
  if (const fs::path data = path_of("XDG_DATA_HOME"); !data.empty()) return data / below;
  if (const fs::path home = path_of("HOME"); !home.empty()) return home / ".local" / "share" / below;
  return tl::unexpected<std::string>(
      "no folder for maps: expected the setting maps_dir, or RDS_MAPS_DIR, XDG_DATA_HOME or HOME with an "
      "absolute "
      "path");
}

tl::expected<void, std::string> make_private_folder(const fs::path& folder) {
  std::error_code error;
  if (folder.empty() || fs::is_directory(folder, error)) return {};
  if (folder.has_parent_path() && folder.parent_path() != folder)
    if (auto above = make_private_folder(folder.parent_path()); !above) return above;
  if (::mkdir(folder.c_str(), S_IRWXU) == 0 || (errno == EEXIST && fs::is_directory(folder, error)))
    return {};
  return tl::unexpected(
      fmt::format("{}: cannot be made a folder: {}", folder.string(), std::strerror(errno)));
}

fs::path checkpoint_file(const fs::path& maps, int domain, const std::string& node_namespace,
                         const std::string& service) {
  const fs::path below = fs::path(node_namespace).relative_path();
  return maps / "checkpoints" / fmt::format("domain-{}", domain) / below / (service + ".db");
}

}  // namespace rds::store
