// SPDX-License-Identifier: Apache-2.0
#include "common/config/overrides.hpp"

namespace rds::config {
namespace {

void merge(YAML::Node target, const YAML::Node& values) {
  for (const auto& entry : values) {
    const auto key = entry.first.as<std::string>();
    if (entry.second.IsMap() && target[key] && target[key].IsMap())
      merge(target[key], entry.second);
    else
      target[key] = entry.second;
  }
}

}  // namespace

YAML::Node merged(const std::string& file, const YAML::Node& values) {
  YAML::Node all = file.empty() ? YAML::Node() : YAML::LoadFile(file);
  if (all.IsNull()) all = YAML::Node(YAML::NodeType::Map);
  merge(all, values);
  return all;
}

ConfigReader from_file_with(const std::string& file, const YAML::Node& values, const std::string& source) {
  if (file.empty()) return {values, source};
  const ConfigReader checked = ConfigReader::from_file(file);
  if (values.size() == 0) return checked;
  return {merged(file, values), file + ", " + source};
}

}  // namespace rds::config
