// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "services/mapper/core/keyframe/keyframe_record.hpp"

namespace rds::mapper {

/// What the boxes of movable objects tell of a keyframe's sampled pixels. All empty without such boxes.
struct DynamicMasks {
  std::vector<std::uint8_t> object;      // 1 where a movable object shows
  std::vector<std::uint8_t> beside;      // 1 in the rim around one, and at another depth in its cells
  std::vector<std::uint8_t> background;  // 1 on planes wider than a person that go on outside the boxes

  [[nodiscard]] bool empty() const { return object.empty(); }
  [[nodiscard]] bool is_object(std::size_t pixel) const { return !object.empty() && object[pixel] != 0; }
  [[nodiscard]] bool is_background(std::size_t pixel) const {
    return !background.empty() && background[pixel] != 0;
  }
  [[nodiscard]] bool is_beside(std::size_t pixel) const { return !beside.empty() && beside[pixel] != 0; }
};

/// Segments a keyframe by the boxes of movable objects, its depth and its colour: segmentation::segment().
/// @param record  with classes by depth. @param boxes  of all objects; static ones are passed over.
DynamicMasks segment_dynamic(const KeyframeRecord& record, std::span<const LabelledBox> boxes,
                             const geometry::DepthNoise& noise);

}  // namespace rds::mapper
