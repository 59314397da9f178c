// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace rds::run {

/// Motion-JPEG video in an AVI file, which every player reads; saves the tools a dependency on a video
/// library.
class MjpegAvi {
 public:
  MjpegAvi(const std::filesystem::path& file, double frames_per_second);
  ~MjpegAvi();
  MjpegAvi(const MjpegAvi&) = delete;
  MjpegAvi& operator=(const MjpegAvi&) = delete;

  /// @param bgr  8-bit; all pictures of one size.
  void add(const cv::Mat& bgr);
  /// Writes the index and the final header. @throws std::runtime_error if the file cannot be written.
  void close();

 private:
  void write_header(std::uint32_t data_bytes);

  std::filesystem::path file_;
  std::ofstream out_;
  double frames_per_second_;
  cv::Size size_;
  std::vector<std::uint32_t> offsets_;  // of each frame's chunk, from the "movi" tag
  std::vector<std::uint32_t> sizes_;
  std::uint32_t movi_bytes_ = 4;
  bool closed_ = false;
};

}  // namespace rds::run
