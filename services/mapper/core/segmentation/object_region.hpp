// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/mapper/core/keyframe/keyframe_record.hpp"

namespace rds::mapper {

/// Image box [px of the full picture] of a labelled box: its own, or the projection of its 3-D box.
/// @return nullopt if it is not finite or has no area inside the picture.
std::optional<geometry::Box2> image_box(const LabelledBox& box, const KeyframeRecord& record);

/// Pixels nearer than this to an object's depth are the object's [m]: a person, arms included, is
/// about 0.6 m deep.
inline constexpr double kHalfDepthM = 0.35;

/// Cuts a static object out of its image box by depth: what stands behind it in the box is not part of it.
///
/// The object's depth is the mean of median and lower third of the depths in the box's inner part (or near
/// `box.depth_m`, or inside the 3-D box, if given); its pixels are those near that depth in the widened box,
/// in connected parts that lie in the box.
/// @return sampled pixels, ascending; none if the box has no usable depth.
/// Source: depth mask inside the box (NGD-SLAM); paper §IV-C asks for points inside the 3-D box.
std::vector<std::size_t> object_region(const KeyframeRecord& record, const LabelledBox& box);

/// Where an object is in a keyframe: inside this box of the picture, between these depths.
struct ObjectPlace {
  geometry::Box2 box_px;  // widened by the margin
  float min_depth_m = 0;
  float max_depth_m = 0;

  /// @param column, row  of a sampled pixel.
  [[nodiscard]] bool is_in_box(const PixelGrid& grid, int column, int row) const {
    return box_px.contains(column * grid.stride, row * grid.stride);
  }
  [[nodiscard]] bool is_at_depth(float depth_m) const {
    return depth_m >= min_depth_m && depth_m <= max_depth_m;
  }
};

/// The place of an object: its 3-D box if known, else its depth in the picture give or take kHalfDepthM.
/// @return nullopt if the box has no usable depth.
std::optional<ObjectPlace> object_place(const KeyframeRecord& record, const LabelledBox& box);

}  // namespace rds::mapper
