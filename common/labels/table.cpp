// SPDX-License-Identifier: Apache-2.0
#include "common/labels/table.hpp"

#include <utility>

namespace rds::labels {

/// Generated: the text of labels.yaml.
extern const char* const kShippedTable;

namespace {

constexpr double kMaxLengthM = 10;

void read(config::ConfigReader& reader, Label& label) {
  reader.value("movable", label.movable);
  reader.value("thickness_m", label.thickness_m, 0.01, kMaxLengthM, "m");
  reader.value("radius_m", label.radius_m, 0.01, kMaxLengthM, "m");
}

void read_color(config::ConfigReader& reader, Label& label) {
  std::vector<int> rgb;
  reader.value("color", rgb);
  if (rgb.size() != 3) return;
  label.color.emplace();
  for (std::size_t i = 0; i < 3; ++i) (*label.color)[i] = static_cast<std::uint8_t>(rgb[i]);
}

}  // namespace

Table::Table() {
  static const Table kShipped = [] {
    Table table(std::map<std::string, Label>{});
    table.add(YAML::Load(kShippedTable), "labels.yaml", true);
    return table;
  }();
  *this = kShipped;
}

Table::Table(std::map<std::string, Label> labels, Label others)
    : labels_(labels.begin(), labels.end()), others_(std::move(others)) {
  for (const auto& [name, label] : labels_)
    for (const std::string& alias : label.aliases) name_of_alias_[alias] = name;
}

void Table::add(const std::string& file) {
  try {
    add(YAML::LoadFile(file), file, false);
  } catch (const YAML::BadFile&) {
    throw config::ConfigError(fmt::format("{}: cannot be read", file));
  } catch (const YAML::ParserException& e) {
    throw config::ConfigError(fmt::format("{}:{}: not YAML: {}", file, e.mark.line + 1, e.msg));
  }
}

void Table::add(const YAML::Node& node, const std::string& source, bool with_colors) {
  config::ConfigReader reader(node, source);
  read(reader.section("default"), others_);
  std::vector<std::string> plain;
  reader.value("others", plain);
  for (const std::string& name : plain) labels_[name] = others_;
  config::ConfigReader& entries = reader.section("labels");
  if (node["labels"] && node["labels"].IsMap())
    for (const auto& entry : node["labels"]) {
      const auto name = entry.first.as<std::string>();
      config::ConfigReader& fields = entries.section(name);
      const Label* known = find(name);
      Label label = others_;
      if (known != nullptr) label.color = known->color;
      fields.value("aliases", label.aliases);
      read(fields, label);
      if (with_colors) read_color(fields, label);
      for (const std::string& alias : label.aliases) name_of_alias_[alias] = name;
      labels_[name] = std::move(label);
    }
  reader.finish();
}

const Label* Table::find(std::string_view label) const {
  const auto alias = name_of_alias_.find(label);
  const auto found = labels_.find(alias == name_of_alias_.end() ? label : alias->second);
  return found == labels_.end() ? nullptr : &found->second;
}

std::string Table::name_of(std::string_view label) const {
  const auto alias = name_of_alias_.find(label);
  return alias == name_of_alias_.end() ? std::string(label) : alias->second;
}

const Label& Table::operator[](std::string_view label) const {
  const Label* known = find(label);
  return known == nullptr ? others_ : *known;
}

void read(config::ConfigReader& reader, Table& table) {
  std::string file;
  reader.value("labels_file", file);
  if (file.empty()) return;
  try {
    table.add(file);
  } catch (const config::ConfigError& e) {
    reader.violation("labels_file", file, e.what());
  }
}

}  // namespace rds::labels
