// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <span>
#include <string>

#include "services/mapper/core/octree/label_table.hpp"

namespace rds::mapper {

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
