// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include <opencv2/core.hpp>

namespace rds::image {

/// Decodes depth of 16 bits in the form RVL: runs of zeros and of values, each value as the difference to the
/// one before it; numbers in groups of three bits, eight groups to a little-endian word. Source: Wilson 2017,
/// "Fast Lossless Depth Image Compression".
///
/// @param size  that the picture is declared to have. Nothing is allocated before the bytes are known to hold
/// just that many values.
/// @return CV_16UC1; empty if the bytes are torn, hold another number of values, or values beyond 16 bits.
cv::Mat decompress_rvl(std::span<const std::uint8_t> bytes, cv::Size size);

}  // namespace rds::image
