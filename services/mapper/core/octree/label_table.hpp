// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "common/map_file/byte_reader.hpp"
#include "common/map_file/byte_writer.hpp"

namespace rds::mapper {

using Rgb = std::array<std::uint8_t, 3>;

/// Colour that stands for a label in every map; depends on the name alone. Source: none, chosen to be told
/// apart.
Rgb label_color(const std::string& label);

/// Labels in order of first appearance; index 0 is "" (no object). Grows, never reorders.
class LabelTable {
 public:
  static constexpr std::size_t kMaxLabels = 4096;

  /// Index of the label, added when new; 0 when the table is full.
  std::uint16_t index_of(const std::string& label);
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  /// Names without the first, which is always "".
  void put(map_file::ByteWriter& writer) const;
  /// Refuses a table that put() cannot have written.
  static LabelTable get(map_file::ByteReader& reader);
  [[nodiscard]] const Rgb& color(std::uint16_t index) const { return colors_[index]; }

 private:
  std::vector<std::string> names_{""};
  std::vector<Rgb> colors_{{255, 255, 255}};
};

/// Labels of a full map by the colours of its voxels, the same for writer and reader. Of labels with one
/// colour the first is meant; a voxel whose surface happens to have a label's colour gets that label.
class ColorLabels {
 public:
  /// @param labels  the label table; index 0 is "".
  explicit ColorLabels(std::span<const std::string> labels);
  /// Index of the label; 0 if the colour is none's.
  [[nodiscard]] std::uint16_t label_of(const Rgb& color) const;

 private:
  std::map<Rgb, std::uint16_t> label_of_color_;
};

}  // namespace rds::mapper
