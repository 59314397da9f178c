// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "services/mapper/core/keyframe/keyframe_record.hpp"

namespace rds::mapper {

/// The pixels of a static object in a keyframe.
struct StaticObject {
  std::vector<std::size_t> pixels;  // indices of sampled pixels, ascending
  bool flush = false;               // hardly anything stands out of the surface behind it (a poster)
};

/// Cuts static objects out of their boxes, all at once: segmentation::segment(), for which what stands in the
/// boxes is the foreground, and planes that go on outside them (floor, wall, the table under a bottle) are
/// not. What is flush with such a plane is cut out of it by its box.
/// @param record  with its classes; only pixels that look static are anybody's. @param colours
/// colours_in_cells() of it. @param boxes  of static objects.
/// @return for each box; no pixels if it has no usable depth. A pixel may be of several.
/// Source: paper §IV-C, where an object is the points of the segmented cloud in its 3-D box.
std::vector<StaticObject> segment_static(const KeyframeRecord& record, const cv::Mat1w& colours,
                                         std::span<const LabelledBox* const> boxes);

}  // namespace rds::mapper
