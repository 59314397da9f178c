// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace rds::bench {

/// A way to pack 16-bit depth without loss that was measured, and not taken.
struct DepthAlternative {
  std::string name;
  std::function<std::vector<std::uint8_t>(const cv::Mat1w&)> compress;
  std::function<cv::Mat1w(const std::vector<std::uint8_t>&, cv::Size)> decompress;
};

/// PNG at its fastest, RVL (Wilson, Fast Lossless Depth Image Compression, 2017, §3), RVL and zstd, zstd of
/// the values as they are, and of differences to the gradient predictor (LOCO-I: Weinberger et al. 2000, Eq.
/// (1)) in byte planes.
std::vector<DepthAlternative> depth_alternatives();

}  // namespace rds::bench
