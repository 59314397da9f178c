// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "common/image/recording.hpp"
#include "tools/rds/doctor/checks/frame_look.hpp"
#include "tools/rds/doctor/registration/depth_registration.hpp"

namespace rds::doctor {

/// What the pictures of a recording show.
struct RecordingLooks {
  std::vector<FrameLook> frames;
  std::vector<std::string> unreadable;  // one sentence each
  std::vector<EdgeView> edges;          // of about 30 frames all over the recording
};

/// Decodes every `every`-th frame once and measures it.
RecordingLooks look_at_pictures(const image::Recording& dataset, std::size_t every);

}  // namespace rds::doctor
