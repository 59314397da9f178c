// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/rds/doctor/checks/finding.hpp"
#include "tools/rds/doctor/checks/frame_look.hpp"

namespace rds::doctor {

/// Colour pictures that repeat the one before although their stamps differ; such as check_exposure() counts
/// are left out.
Finding check_frozen(const std::vector<FrameLook>& frames);
/// Pictures far less sharp than the recording's others, or than any lens in focus makes them.
Finding check_blur(const std::vector<FrameLook>& frames);
/// Black, white and flat pictures: no light, a covered lens.
Finding check_exposure(const std::vector<FrameLook>& frames);
/// Pictures much brighter or darker than the one before; such as check_exposure() counts are left out.
Finding check_exposure_jumps(const std::vector<FrameLook>& frames);

}  // namespace rds::doctor
