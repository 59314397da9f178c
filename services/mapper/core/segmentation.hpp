// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/mapper/core/keyframe_record.hpp"

namespace rds::mapper {

/// A connected piece of surface that is no large plane, or (is_plane) one of the large planes.
struct Segment {
  geometry::Box2 box_px;            // of the full picture
  std::vector<std::size_t> pixels;  // indices of sampled pixels, ascending
  bool is_plane = false;
};

/// Splits a keyframe's organised cloud into planes and the clusters that remain when the planes are removed:
/// integral-image normals, organised multi-plane segmentation, Euclidean clustering of the rest (PCL).
///
/// Pixels without depth are NaN, never (0, 0, 0). Pixels that are not kStatic take no part.
/// Source: paper §IV-C, module "Point Cloud Segmentation".
std::vector<Segment> segment(const KeyframeRecord& record, const SegmentationConfig& config);

/// The segment that an image box most likely shows: highest IoU, less for centres that are far apart.
/// A plane is taken only if it fills the box (a table top), not because it passes behind the object.
/// @return nullptr if none overlaps enough.
const Segment* best_segment(const std::vector<Segment>& segments, const geometry::Box2& box_px,
                            const SegmentationConfig& config);

}  // namespace rds::mapper
