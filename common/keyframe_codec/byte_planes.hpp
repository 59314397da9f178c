// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include <opencv2/core.hpp>

namespace rds::keyframe_codec {

/// Rearranges a picture so that a general compressor finds much to save: the difference of each pixel to its
/// left neighbour (of the first in a row to the one above, of the very first to 0), modulo the pixel's range,
/// with the sign in the lowest bit (zig-zag: 0, -1, 1, -2, … become 0, 1, 2, 3, …), then the lowest bytes of
/// all pixels, the next ones, and so on.
///
/// @param pixels  one channel of 8, 16 or 32 bits; floats are taken as their bits. Rows may have padding.
/// @param planes  of rows × columns × bytes per pixel.
/// @throws std::invalid_argument for other pixels or another length.
void to_byte_planes(const cv::Mat& pixels, std::span<std::uint8_t> planes);

/// The reverse; every content of `planes` is a picture. @throws as above.
void from_byte_planes(std::span<const std::uint8_t> planes, cv::Mat& pixels);

}  // namespace rds::keyframe_codec
