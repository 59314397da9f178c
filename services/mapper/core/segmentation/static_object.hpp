// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "services/mapper/core/segmentation/object_region.hpp"
#include "services/mapper/core/segmentation/segmentation.hpp"

namespace rds::mapper {

/// The pixels of a static object in a keyframe.
struct StaticObject {
  std::vector<std::size_t> pixels;  // indices of sampled pixels, ascending
  bool flush = false;  // nearly all its pixels lie on a large plane that goes on around it (a poster)
};

/// A static object as a keyframe shows it: what the depth cut leaves of its box, corrected by the segments of
/// the point cloud.
///
/// A segment that mostly lies in the object's place is the object's as far as it is in the box (the seat of a
/// chair whose back made the cut); one that mostly lies elsewhere is not. What lies on a large plane that
/// bounds the object is not the object's either: the floor between its legs, the wall behind it, the table
/// under it. What is flush with such a plane is cut out of it by its box.
/// @return no pixels if the box has no usable depth.
StaticObject static_object(const KeyframeRecord& record, const LabelledBox& box,
                           std::span<const Segment> segments, const MapperConfig& config);

}  // namespace rds::mapper
