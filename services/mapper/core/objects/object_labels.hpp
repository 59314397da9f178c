// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "services/mapper/core/keyframe/keyframe_record.hpp"
#include "services/mapper/core/octree/label_table.hpp"

namespace rds::mapper {

/// Gives the pixels of static objects their label, and keeps a sighting of each object; replaces earlier
/// ones.
///
/// Where objects overlap, the one with the higher score has the pixel; the nearer one where scores are equal.
/// @param record  with its classes. @param colours  colours_in_cells() of it. @param boxes  of all objects;
/// movable ones are passed over.
void label_static_objects(KeyframeRecord& record, const cv::Mat1w& colours,
                          std::span<const LabelledBox> boxes, const MapperConfig& config, LabelTable& labels);

}  // namespace rds::mapper
