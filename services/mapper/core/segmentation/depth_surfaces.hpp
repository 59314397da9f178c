// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/mapper/core/keyframe/keyframe_record.hpp"

namespace rds::mapper {

/// 255 where a pixel and all within 4 sampled pixels have no depth; 0 elsewhere, and near the picture's
/// border. Of the size of the sampled picture.
cv::Mat1b without_depth_all_around(const KeyframeRecord& record);

/// True if at least so many of the 8 neighbours are of this pixel's surface; a camera measures flying
/// pixels between two surfaces.
bool is_on_surface(const KeyframeRecord& record, int column, int row, int edge_support);

/// Surfaces of a keyframe: connected components of the static, doubtful and unknown pixels; neighbours are
/// connected if their depths differ by no more than SurfaceSteps say.
///
/// @param surface  of each pixel, from 1; 0 for other classes and for components of fewer than 8 pixels.
/// @return the number of surfaces.
std::uint16_t find_surfaces(const KeyframeRecord& record, std::vector<std::uint16_t>& surface);

}  // namespace rds::mapper
