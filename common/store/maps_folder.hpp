// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include <tl/expected.hpp>

#include "common/config/config_reader.hpp"

namespace rds::store {

/// Where a service keeps maps, and whether it keeps its own there while it runs.
struct MapsConfig {
  std::string maps_dir;  // empty: $RDS_MAPS_DIR, $XDG_DATA_HOME/rds-slam/maps or ~/.local/share/rds-slam/maps
  bool checkpoint = true;   // the live map is kept in checkpoints/ below it, and taken back at a start
  double checkpoint_s = 5;  // between two checkpoints, when something has changed
  double backup_s = 600;    // between two copies of it, which serve if it is damaged; 0: none
  std::uint64_t max_map_mb = 4000;  // a larger file of a saved map is not read

  bool operator==(const MapsConfig&) const = default;
};

void read(config::ConfigReader& reader, MapsConfig& config);

/// The folder of maps, absolute; it need not exist.
/// @return or one sentence, where neither setting nor environment names one.
tl::expected<std::filesystem::path, std::string> maps_folder(const MapsConfig& config);

/// Makes a folder and those above it that are missing, each with mode 0700; what is there stays as it is.
/// @return or one sentence naming the folder that is none, or cannot be made.
tl::expected<void, std::string> make_private_folder(const std::filesystem::path& folder);

/// checkpoints/domain-N/SERVICE.db below the folder of maps: the checkpoint of a service in a DDS domain. Of a
/// robot with a namespace checkpoints/domain-N/robot1/SERVICE.db.
/// @param node_namespace  "/robot1"; "/" for none.
std::filesystem::path checkpoint_file(const std::filesystem::path& maps, int domain,
                                      const std::string& node_namespace, const std::string& service);

}  // namespace rds::store
