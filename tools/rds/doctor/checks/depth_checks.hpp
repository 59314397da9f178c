// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/rds/doctor/checks/finding.hpp"
#include "tools/rds/doctor/checks/frame_look.hpp"

namespace rds::doctor {

/// Metres that can be: a median beyond 0.15 … 20 m is a fault. Depth that starts before 0.35 m and ends
/// before 1.2 m, or starts beyond 2.5 m and ends beyond 9 m, is a hint: as a rule millimetres and fifths of
/// them were mixed up. The sentence names the usual scales that would be plausible.
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
