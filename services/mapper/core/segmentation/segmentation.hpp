// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/mapper/core/segmentation/planes.hpp"

namespace rds::mapper {

/// A connected piece of surface that is no large plane, or one of the large planes.
struct Segment {
  geometry::Box2 box_px;            // of the full picture
  std::vector<std::size_t> pixels;  // indices of sampled pixels, ascending
  std::optional<Plane> plane;       // camera frame
};

/// Splits a keyframe's organised cloud into planes and the clusters that remain when the planes are removed:
/// find_planes(), Euclidean clustering of the rest (PCL).
///
/// Pixels without depth are NaN, never (0, 0, 0). Pixels that are not kStatic take no part.
/// Source: paper §IV-C, module "Point Cloud Segmentation".
std::vector<Segment> segment(const KeyframeRecord& record, const MapperConfig& config);

}  // namespace rds::mapper
