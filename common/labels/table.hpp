// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/config/config_reader.hpp"

namespace rds::labels {

/// What a label means; labels.yaml explains the fields.
struct Label {
  std::vector<std::string> aliases = {};
  bool movable = false;
  double thickness_m = 0.4;
  double radius_m = 0.6;
  std::optional<std::array<std::uint8_t, 3>> color = {};  // red, green, blue

  bool operator==(const Label&) const = default;
};

/// The table of labels: the shipped one, with what a user's file adds or redefines.
class Table {
 public:
  /// The shipped table.
  Table();
  /// @param labels  by name. @param others  what every other label means.
  explicit Table(std::map<std::string, Label> labels, Label others = {});

  /// Adds the entries of a YAML file like labels.yaml, in place of those with the same name.
  /// @throws config::ConfigError listing all that is wrong in it.
  void add(const std::string& file);

  /// By name or alias; nullptr for a label that the table does not know.
  [[nodiscard]] const Label* find(std::string_view label) const;
  /// The name of which `label` is an alias; `label` if it is none.
  [[nodiscard]] std::string name_of(std::string_view label) const;
  /// What a label means; one that is not in the table means what its line `default` says.
  [[nodiscard]] const Label& operator[](std::string_view label) const;

  bool operator==(const Table&) const = default;

 private:
  void add(const YAML::Node& node, const std::string& source, bool with_colors);

  std::map<std::string, Label, std::less<>> labels_;
  std::map<std::string, std::string, std::less<>> name_of_alias_;
  Label others_;
};

/// The setting labels_file; what is wrong in that file is a violation of the setting.
void read(config::ConfigReader& reader, Table& table);

}  // namespace rds::labels
