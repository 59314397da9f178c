// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "services/mapper/core/keyframe/keyframe_record.hpp"

namespace rds::mapper {

/// What the boxes of movable objects tell of a sampled pixel.
enum class ByBoxes : std::uint8_t {
  kNothing,
  kBackground,  // on a plane wider than a person that goes on outside the boxes
  kBeside,      // in the rim around a movable object, or at another depth in its cells
  kMovable,     // shows a movable object
};

/// Segments a keyframe by the boxes of movable objects, its depth and its colour: segmentation::segment().
/// @param record  with classes by depth. @param colours  colours_in_cells() of it. @param boxes  of all
/// objects; static ones are passed over.
/// @return of each sampled pixel; empty without boxes of movable objects.
std::vector<ByBoxes> segment_dynamic(const KeyframeRecord& record, const cv::Mat1w& colours,
                                     std::span<const LabelledBox> boxes);

}  // namespace rds::mapper
