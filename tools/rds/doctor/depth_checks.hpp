// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/rds/doctor/finding.hpp"
#include "tools/rds/doctor/frame_look.hpp"

namespace rds::doctor {

/// Metres that can be: a median of 0.15 … 20 m is a must; measurements from nearer than 0.2 m that all end
/// before 1.5 m, or none nearer than 1.8 m and some beyond 12 m, are as rule those of another scale.
/// The sentence names the usual scales (1000, 5000, …) that would be plausible.
///
/// @param depth_scale  raw units per metre, as used.
Finding check_depth_scale(const std::vector<FrameLook>& frames, double depth_scale);
/// Depth pictures with few measurements.
Finding check_depth_share(const std::vector<FrameLook>& frames);
/// Depth pictures that hold little but one value: constant, saturated, another mark for `no measurement`.
Finding check_depth_values(const std::vector<FrameLook>& frames);
/// Depth pictures that repeat the one before although their stamps differ.
Finding check_depth_frozen(const std::vector<FrameLook>& frames);

}  // namespace rds::doctor
