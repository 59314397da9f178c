// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "services/mapper/core/keyframe/keyframe_record.hpp"

namespace rds::mapper {

/// The pixels that show a wall, a floor, a table top behind or beside somebody: planes that go on outside all
/// that is movable for more than a person's width.
///
/// @param record   before anything in it is marked as movable.
/// @param movable  boxes [px of the full picture], rims included.
/// @return per pixel; empty without boxes.
std::vector<bool> find_background(const KeyframeRecord& record, std::span<const geometry::Box2> movable,
                                  const SegmentationConfig& config);

}  // namespace rds::mapper
