// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/mapper/core/keyframe/keyframe_record.hpp"

namespace rds::mapper {

/// 255 where a pixel and all within 4 sampled pixels have no depth; 0 elsewhere, and near the picture's
/// border. Of the size of the sampled picture.
cv::Mat1b without_depth_all_around(const KeyframeRecord& record);

/// By how much the depths of neighbouring pixels of one surface differ at most: by noise (difference_m()) or,
/// if that is more, by slant. A surface that is seen at more than 7° changes by less than .03 m ×
/// max(1, depth / 1 m) from one sampled pixel to the next (2 px of 525).
int surface_step_tenth_mm(int depth_tenth_mm, const geometry::DepthNoise& noise);

/// True if at least edge_support of the 8 neighbours are of this pixel's surface; a camera measures flying
/// pixels between two surfaces.
bool is_on_surface(const KeyframeRecord& record, int column, int row, const SamplingConfig& config);

/// Surfaces of a keyframe: connected components of the static, doubtful and unknown pixels; neighbours are
/// connected if their depths differ by no more than surface_step_tenth_mm().
///
/// @param surface  of each pixel, from 1; 0 for other classes and for components of fewer than 8 pixels.
/// @return the number of surfaces.
std::uint16_t find_surfaces(const KeyframeRecord& record, const geometry::DepthNoise& noise,
                            std::vector<std::uint16_t>& surface);

}  // namespace rds::mapper
