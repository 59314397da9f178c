// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/octree/label_table.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace rds::mapper {
namespace {

const std::map<std::string, Rgb>& known_colors() {
  static const std::map<std::string, Rgb> kColors = {
      {"person", {214, 39, 40}},        {"chair", {31, 119, 180}},        {"sofa", {148, 103, 189}},
      {"couch", {148, 103, 189}},       {"diningtable", {255, 127, 14}},  {"dining table", {255, 127, 14}},
      {"table", {255, 127, 14}},        {"tvmonitor", {23, 190, 207}},    {"tv", {23, 190, 207}},
      {"monitor", {23, 190, 207}},      {"bottle", {44, 160, 44}},        {"pottedplant", {106, 191, 75}},
      {"potted plant", {106, 191, 75}}, {"laptop", {227, 119, 194}},      {"keyboard", {188, 189, 34}},
      {"book", {140, 86, 75}},          {"shelf", {140, 86, 75}},         {"box", {196, 156, 90}},
      {"cup", {240, 200, 40}},          {"refrigerator", {90, 110, 200}}, {"sink", {0, 140, 140}}};
  return kColors;
}

Rgb color_of_hue(double hue, double lightness) {
  const auto channel = [&](double shift) {
    const double wave = 0.5 + 0.5 * std::cos(2 * 3.14159265358979 * (hue - shift));
    return static_cast<std::uint8_t>(std::lround(255 * (0.15 + 0.8 * wave * lightness)));
  };
  return {channel(0), channel(1.0 / 3), channel(2.0 / 3)};
}

}  // namespace

Rgb label_color(const std::string& label) {
  if (label.empty()) return {255, 255, 255};
  const auto known = known_colors().find(label);
  if (known != known_colors().end()) return known->second;
  std::uint32_t hash = 2166136261U;  // FNV-1a
  for (const char c : label) hash = (hash ^ static_cast<std::uint8_t>(c)) * 16777619U;
  return color_of_hue((hash % 97) / 97.0, 0.75 + 0.25 * ((hash >> 8 & 255) / 255.0));
}

std::uint16_t LabelTable::index_of(const std::string& label) {
  const auto found = std::ranges::find(names_, label);
  if (found != names_.end()) return static_cast<std::uint16_t>(found - names_.begin());
  if (names_.size() >= kMaxLabels) return 0;
  names_.push_back(label);
  colors_.push_back(label_color(label));
  return static_cast<std::uint16_t>(names_.size() - 1);
}

void LabelTable::put(map_file::ByteWriter& writer) const {
  writer.put_count(names_.size() - 1);
  for (std::size_t i = 1; i < names_.size(); ++i) writer.put_text(names_[i]);
}

LabelTable LabelTable::get(map_file::ByteReader& reader) {
  LabelTable labels;
  const std::size_t count = reader.get_count(sizeof(std::uint64_t));
  for (std::size_t i = 1; i <= count && reader.ok(); ++i)
    if (labels.index_of(reader.get_text()) != i) reader.refuse("a label twice, or too many");
  return labels;
}

}  // namespace rds::mapper
