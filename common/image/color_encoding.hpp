// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <opencv2/core.hpp>

namespace rds::image {

/// How the pixels of an encoding of sensor_msgs/Image lie in memory, and how they become colours.
struct ColorEncoding {
  std::string_view name;
  int type;                       // of OpenCV, of the pixels in the message
  std::optional<int> conversion;  // of cv::cvtColor() to BGR; none: BGR or RGB as they are
  bool needs_even_size = false;   // two pixels share their colour, or a pattern repeats
};

/// nullptr for a name that is none of a colour (or grey) picture.
const ColorEncoding* find_color_encoding(const std::string& name);

/// "rgb8, bgr8, …": all that find_color_encoding() knows.
std::string color_encodings();

/// A BGR copy (CV_8UC3) of pixels in an encoding with a conversion.
/// @param is_big_endian  of 16-bit grey values.
cv::Mat to_bgr(const cv::Mat& pixels, const ColorEncoding& encoding, bool is_big_endian);

/// A copy with the bytes of each value reversed: big-endian values as this machine has them.
cv::Mat swapped(const cv::Mat& values);

}  // namespace rds::image
