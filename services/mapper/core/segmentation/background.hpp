// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "services/mapper/core/keyframe/keyframe_record.hpp"

namespace rds::mapper {

/// The pixels on background planes: walls, floors and table tops that go on outside of all boxes of movable
/// objects for more than a person's width.
///
/// @param record   with classes by depth.
/// @param movable  boxes [px of the full picture], rims included.
/// @return 1 for each such pixel, 0 for others; empty without boxes.
std::vector<std::uint8_t> find_background(const KeyframeRecord& record,
                                          std::span<const geometry::Box2> movable,
                                          const geometry::DepthNoise& noise);

}  // namespace rds::mapper
