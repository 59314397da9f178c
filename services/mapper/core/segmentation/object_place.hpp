// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/dynamic_segmentation/object_region.hpp"
#include "services/mapper/core/keyframe/keyframe_record.hpp"

namespace rds::mapper {

/// Image box [px of the full picture] of a labelled box: its own, or the projection of its 3-D box.
/// @return nullopt if it is not finite or has no area inside the picture.
std::optional<geometry::Box2> image_box(const LabelledBox& box, const KeyframeRecord& record);

/// Where an object is in a keyframe: its image box, and the depths between which its surface lies: near its
/// depth (told with the box, else measured in the box's inner part), or in its 3-D box.
/// A static object is as deep as it is wide; a person, arms included, about 0.6 m.
/// @return nullopt if the box has no usable depth.
std::optional<segmentation::ObjectRegion> object_place(const KeyframeRecord& record, const LabelledBox& box);

}  // namespace rds::mapper
