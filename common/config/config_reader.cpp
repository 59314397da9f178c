// SPDX-License-Identifier: Apache-2.0
#include "common/config/config_reader.hpp"

#include <algorithm>

namespace rds::config {

ConfigReader::ConfigReader(const YAML::Node& node, std::string source)
    : node_(node), source_(std::move(source)) {
  if (node_.IsNull()) node_ = YAML::Node(YAML::NodeType::Map);
  if (!node_.IsMap()) throw ConfigError(fmt::format("{}: expected a map of keys and values", source_));
}

ConfigReader ConfigReader::from_file(const std::string& path) {
  try {
    return {YAML::LoadFile(path), path};
  } catch (const YAML::BadFile&) {
    throw ConfigError(fmt::format("{}: cannot be read", path));
  } catch (const YAML::ParserException& e) {
    throw ConfigError(fmt::format("{}:{}: not YAML: {}", path, e.mark.line + 1, e.msg));
  }
}

void ConfigReader::choice(const std::string& key, std::string& target,
                          const std::vector<std::string>& allowed) {
  std::string read = target;
  if (!take(key, read)) return;
  if (std::ranges::find(allowed, read) == allowed.end())
    violation(key, read, fmt::format("expected one of: {}", fmt::join(allowed, ", ")));
  else
    target = read;
}

std::vector<std::string> ConfigReader::keys() const {
  std::vector<std::string> keys;
  for (const auto& entry : node_) keys.push_back(entry.first.as<std::string>());
  return keys;
}

ConfigReader& ConfigReader::section(const std::string& key) {
  known_.insert(key);
  const auto existing = sections_.find(key);
  if (existing != sections_.end()) return existing->second;
  ConfigReader child;
  if (node_[key]) {
    if (node_[key].IsMap())
      child = ConfigReader(node_[key], source_);
    else
      violation(key, YAML::Dump(node_[key]), "expected a map");
  }
  child.source_ = source_;
  child.prefix_ = prefix_ + key + ".";
  return sections_.emplace(key, std::move(child)).first->second;
}

void ConfigReader::violation(const std::string& key, const std::string& value, const std::string& expected) {
  violations_.push_back(fmt::format("{}: {}{}: {}, {}", source_, prefix_, key, value, expected));
}

void ConfigReader::collect(std::vector<std::string>& all) const {
  all.insert(all.end(), violations_.begin(), violations_.end());
  for (const auto& entry : node_) {
    const auto key = entry.first.as<std::string>();
    if (!known_.contains(key)) all.push_back(fmt::format("{}: {}{}: unknown key", source_, prefix_, key));
  }
  for (const auto& [key, child] : sections_) child.collect(all);
}

std::vector<std::string> ConfigReader::absent() const {
  std::vector<std::string> keys;
  for (const std::string& key : known_)
    if (!has(key)) keys.push_back(prefix_ + key);
  for (const auto& [key, child] : sections_) std::ranges::copy(child.absent(), std::back_inserter(keys));
  return keys;
}

void ConfigReader::finish() {
  std::vector<std::string> all;
  collect(all);
  if (!all.empty()) throw ConfigError(fmt::format("{}", fmt::join(all, "\n")));
}

}  // namespace rds::config
