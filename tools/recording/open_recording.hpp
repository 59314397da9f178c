// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include <tl/expected.hpp>

#include "common/image/recording.hpp"

namespace rds::recording {

struct OpenedRecording {
  std::unique_ptr<image::Recording> recording;
  std::string notes;  // what the user may want to know of it: lines to stderr
};

/// Opens a recording in any form that is known by its layout: a folder in TUM form, an MCAP file, a SQLite
/// file or folder of rosbag2, a folder of a known benchmark (benchmarks/benchmarks.hpp).
/// @return or one sentence that names the place and what was expected.
tl::expected<OpenedRecording, std::string> open_recording(const std::filesystem::path& path);

}  // namespace rds::recording
