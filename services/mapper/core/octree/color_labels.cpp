// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/octree/color_labels.hpp"

#include <algorithm>

namespace rds::mapper {

ColorLabels::ColorLabels(std::span<const std::string> labels) {
  for (std::size_t i = 1; i < std::min(labels.size(), LabelTable::kMaxLabels); ++i)
    label_of_color_.emplace(label_color(labels[i]), static_cast<std::uint16_t>(i));
}

std::uint16_t ColorLabels::label_of(const Rgb& color) const {
  const auto found = label_of_color_.find(color);
  return found == label_of_color_.end() ? std::uint16_t{0} : found->second;
}

}  // namespace rds::mapper
