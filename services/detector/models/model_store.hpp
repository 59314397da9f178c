// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "services/detector/core/detector.hpp"
#include "services/detector/core/network_description.hpp"

namespace rds::detector {

using ModelFolders = std::vector<std::filesystem::path>;

/// Where networks are looked up, first to last: `model_dir` (if not empty), $RDS_SHARED/models, the user's
/// cache.
ModelFolders model_folders(const std::filesystem::path& model_dir = {});

/// $XDG_CACHE_HOME/rds-slam/models, or ~/.cache/rds-slam/models. Empty if neither variable is set.
std::filesystem::path model_cache();

/// The networks that this program knows by name.
std::vector<NetworkDescription> shipped_networks();

/// A shipped network by its name, or the network that a YAML file describes: `name` is that file's path, or
/// NAME.yaml lies in one of the folders.
/// @throws DetectorError if there is none; config::ConfigError if the YAML is not valid.
NetworkDescription find_description(const std::string& name, const ModelFolders& folders);

/// The first folder's file of this network; its content is not looked at.
std::optional<std::filesystem::path> find_file(const NetworkDescription& network,
                                               const ModelFolders& folders);

/// The paper's network where its file is found, else nanodet_g.
std::string default_network(const ModelFolders& folders);

/// The network `name` (empty: default_network()) with the checked content of its file.
/// @throws DetectorError if the file is missing, cannot be read, or is another one than described (SHA-256).
Network load_network(const std::string& name, const ModelFolders& folders);
Network load_network(const NetworkDescription& description, const ModelFolders& folders);

}  // namespace rds::detector
