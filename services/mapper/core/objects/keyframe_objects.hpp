// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "services/mapper/core/keyframe/keyframe_record.hpp"
#include "services/mapper/core/octree/label_table.hpp"

namespace rds::mapper {

/// Applies a keyframe's boxes to its record, replacing what earlier boxes did: marks movable objects, gives
/// the pixels of static objects their label, and keeps each static object's boundary.
///
/// What shows large planes that go on outside of all movable boxes is of nobody in them, and beyond doubt.
/// Where objects overlap, the one with the higher score has the pixel; the nearer one where scores are equal.
void apply_boxes(KeyframeRecord& record, std::span<const LabelledBox> boxes, const MapperConfig& config,
                 LabelTable& labels);

}  // namespace rds::mapper
