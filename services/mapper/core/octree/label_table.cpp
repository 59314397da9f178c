// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/octree/label_table.hpp"

#include <algorithm>
#include <cmath>

#include "common/labels/table.hpp"

namespace rds::mapper {
namespace {

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
  static const labels::Table kTable;
  if (const auto& color = kTable[label].color) return {(*color)[0], (*color)[1], (*color)[2]};
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

ColorLabels::ColorLabels(std::span<const std::string> labels) {
  for (std::size_t i = 1; i < std::min(labels.size(), LabelTable::kMaxLabels); ++i)
    label_of_color_.emplace(label_color(labels[i]), static_cast<std::uint16_t>(i));
}

std::uint16_t ColorLabels::label_of(const Rgb& color) const {
  const auto found = label_of_color_.find(color);
  return found == label_of_color_.end() ? std::uint16_t{0} : found->second;
}

}  // namespace rds::mapper
