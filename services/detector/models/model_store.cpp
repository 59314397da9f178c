// SPDX-License-Identifier: Apache-2.0
#include "services/detector/models/model_store.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include <fmt/format.h>

#include "services/detector/models/file_digest.hpp"

namespace rds::detector {
namespace fs = std::filesystem;
namespace {

constexpr const char* kPapersNetwork = "mobilenetv2_ssdlite_voc";
constexpr const char* kFallbackNetwork = "nanodet_g";

fs::path from_environment(const char* variable) {
  const char* value = std::getenv(variable);
  return value == nullptr ? fs::path() : fs::path(value);
}

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

std::string names_of(const ModelFolders& folders) {
  std::vector<std::string> names;
  for (const fs::path& folder : folders) names.push_back(folder.string());
  return fmt::format("{}", fmt::join(names, ", "));
}

std::vector<unsigned char> read_bytes(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<unsigned char> bytes{std::istreambuf_iterator<char>(file), {}};
  if (!file || bytes.empty()) throw DetectorError(fmt::format("{}: cannot be read", path.string()));
  return bytes;
}

std::string remedy(const NetworkDescription& network) {
  if (!network.fetch.empty()) return fmt::format("; `{}` brings it", network.fetch);
  return fmt::format("; put it there, or name its folder with --model-dir (source: {})", network.source);
}

}  // namespace

fs::path model_cache() {
  fs::path cache = from_environment("XDG_CACHE_HOME");
  if (cache.empty() && !from_environment("HOME").empty()) cache = from_environment("HOME") / ".cache";
  return cache.empty() ? cache : cache / "rds-slam" / "models";
}

ModelFolders model_folders(const fs::path& model_dir) {
  ModelFolders folders;
  if (!model_dir.empty()) folders.push_back(model_dir);
  if (const fs::path shared = from_environment("RDS_SHARED"); !shared.empty())
    folders.push_back(shared / "models");
  if (const fs::path cache = model_cache(); !cache.empty()) folders.push_back(cache);
  return folders;
}

NetworkDescription find_description(const std::string& name, const ModelFolders& folders) {
  std::vector<NetworkDescription> shipped = shipped_networks();
  if (const auto known = std::ranges::find(shipped, name, &NetworkDescription::name); known != shipped.end())
    return *known;
  std::vector<fs::path> files{name};
  for (const fs::path& folder : folders) files.push_back(folder / (name + ".yaml"));
  const auto file = std::ranges::find_if(files, is_file);
  if (file != files.end()) {
    try {
      return parse_network(YAML::LoadFile(file->string()), file->string());
    } catch (const YAML::Exception& e) {
      throw DetectorError(fmt::format("{}:{}: not YAML: {}", file->string(), e.mark.line + 1, e.msg));
    }
  }
  std::vector<std::string> names;
  names.reserve(shipped.size());
  for (const NetworkDescription& network : shipped) names.push_back(network.name);
  throw DetectorError(fmt::format("network '{}': expected one of {} or a YAML file that describes it", name,
                                  fmt::join(names, ", ")));
}

std::optional<fs::path> find_file(const NetworkDescription& network, const ModelFolders& folders) {
  for (const fs::path& folder : folders)
    if (is_file(folder / network.file)) return folder / network.file;
  return std::nullopt;
}

std::string default_network(const ModelFolders& folders) {
  const bool found = find_file(find_description(kPapersNetwork, folders), folders).has_value();
  return found ? kPapersNetwork : kFallbackNetwork;
}

Network load_network(const std::string& name, const ModelFolders& folders) {
  return load_network(find_description(name.empty() ? default_network(folders) : name, folders), folders);
}

Network load_network(const NetworkDescription& description, const ModelFolders& folders) {
  const auto path = find_file(description, folders);
  if (!path)
    throw DetectorError(fmt::format("network {}: {} was not found in {}{}", description.name,
                                    description.file, folders.empty() ? "any folder" : names_of(folders),
                                    remedy(description)));
  Network network{description, read_bytes(*path)};
  if (const std::string digest = sha256_hex(network.weights); digest != description.sha256)
    throw DetectorError(fmt::format("{}: not the file of network {}: expected SHA-256 {}, got {}",
                                    path->string(), description.name, description.sha256, digest));
  return network;
}

}  // namespace rds::detector
