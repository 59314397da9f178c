// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/image/rgbd_frame.hpp"

namespace rds::bench {

/// One colour picture of a TUM folder and the depth picture nearest in time (empty path if none within 20
/// ms).
struct RecordedFrame {
  std::string stamp;  // [s] as written in rgb.txt
  std::filesystem::path color;
  std::filesystem::path depth;
};

/// The frames that rgb.txt and depth.txt list. @throws std::runtime_error if rgb.txt cannot be read.
std::vector<RecordedFrame> list_frames(const std::filesystem::path& dataset);

/// Metres per unit of the depth pictures: 1 / depth_scale of camera.yaml, TUM's 1/5000 without that file.
float metres_per_unit(const std::filesystem::path& dataset);

/// The depth picture of a frame; without values if it has none.
image::DepthImage load_depth(const RecordedFrame& frame, float metres_per_unit);

}  // namespace rds::bench
