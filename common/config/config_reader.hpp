// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

namespace rds::config {

/// What is wrong with a configuration: one sentence per violation, all of them, joined by newlines.
class ConfigError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Reads a YAML map into plain structs and collects every violation before it complains.
///
/// Usage, per struct: `void read(ConfigReader& r, FooConfig& c) { r.value("size", c.size, 1, 10, "px"); }`.
/// A key that is absent keeps the struct's default; a key that no read() asked for is a violation.
class ConfigReader {
 public:
  /// An empty configuration: every default stays.
  ConfigReader() = default;
  /// @param source  named in messages, e.g. the file's path.
  ConfigReader(const YAML::Node& node, std::string source);
  /// @throws ConfigError if the file cannot be read or is not a YAML map.
  static ConfigReader from_file(const std::string& path);

  /// Number within [lowest, highest]; `unit` is for the message ("m", "px", "" for none).
  template <class T>
  void value(const std::string& key, T& target, T lowest, T highest, const std::string& unit = "") {
    T read = target;
    if (!take(key, read)) return;
    if (!(read >= lowest && read <= highest))
      violation(key, fmt::format("{}", read),
                fmt::format("expected {} … {}{}{}", lowest, highest, unit.empty() ? "" : " ", unit));
    else
      target = read;
  }

  /// String, bool or list without a range.
  template <class T>
  void value(const std::string& key, T& target) {
    take(key, target);
  }

  /// One of several words.
  void choice(const std::string& key, std::string& target, const std::vector<std::string>& allowed);

  /// True if the configuration gives this key.
  [[nodiscard]] bool has(const std::string& key) const { return node_.IsMap() && node_[key]; }

  /// Keys of the configuration, for maps whose keys are names.
  [[nodiscard]] std::vector<std::string> keys() const;

  /// Reader of the map below `key` (empty if absent); its violations are added to this reader's by finish().
  ConfigReader& section(const std::string& key);

  /// Every key that was asked for and that the configuration does not give, in full.
  [[nodiscard]] std::vector<std::string> absent() const;

  void violation(const std::string& key, const std::string& value, const std::string& expected);

  /// @throws ConfigError listing all violations, unknown keys included.
  void finish();

 private:
  template <class T>
  bool take(const std::string& key, T& target) {
    known_.insert(key);
    if (!node_.IsMap() || !node_[key]) return false;
    try {
      target = node_[key].template as<T>();
      return true;
    } catch (const YAML::Exception&) {
      violation(key, YAML::Dump(node_[key]), "a value of another type");
      return false;
    }
  }
  void collect(std::vector<std::string>& all) const;

  YAML::Node node_ = YAML::Node(YAML::NodeType::Map);
  std::string source_ = "defaults";
  std::string prefix_;
  std::set<std::string> known_;
  std::map<std::string, ConfigReader> sections_;
  std::vector<std::string> violations_;
};

}  // namespace rds::config
