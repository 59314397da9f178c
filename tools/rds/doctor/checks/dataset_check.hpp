// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "common/image/recording.hpp"
#include "tools/rds/doctor/checks/finding.hpp"
#include "tools/rds/doctor/checks/recording_looks.hpp"

namespace rds::doctor {

/// All that can be told of a recording: its lists, the camera, and every `every`-th frame's pictures, each
/// decoded once.
std::vector<Finding> check_dataset(const image::Recording& dataset, std::size_t every);

/// Pictures that cannot be read: torn, of another size than camera.yaml says, not there.
Finding check_unreadable(const RecordingLooks& looks);

}  // namespace rds::doctor
