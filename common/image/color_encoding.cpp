// SPDX-License-Identifier: Apache-2.0
#include "common/image/color_encoding.hpp"

#include <algorithm>
#include <array>

#include <opencv2/imgproc.hpp>

namespace rds::image {
namespace {

// OpenCV names a Bayer pattern by the second row's second and third pixel, ROS by the first row.
const std::array<ColorEncoding, 14> kEncodings{{{"rgb8", CV_8UC3, {}},
                                                {"bgr8", CV_8UC3, {}},
                                                {"rgba8", CV_8UC4, cv::COLOR_RGBA2BGR},
                                                {"bgra8", CV_8UC4, cv::COLOR_BGRA2BGR},
                                                {"mono8", CV_8UC1, cv::COLOR_GRAY2BGR},
                                                {"mono16", CV_16UC1, cv::COLOR_GRAY2BGR},
                                                {"yuv422", CV_8UC2, cv::COLOR_YUV2BGR_UYVY, true},
                                                {"uyvy", CV_8UC2, cv::COLOR_YUV2BGR_UYVY, true},
                                                {"yuv422_yuy2", CV_8UC2, cv::COLOR_YUV2BGR_YUYV, true},
                                                {"yuyv", CV_8UC2, cv::COLOR_YUV2BGR_YUYV, true},
                                                {"bayer_rggb8", CV_8UC1, cv::COLOR_BayerBG2BGR, true},
                                                {"bayer_bggr8", CV_8UC1, cv::COLOR_BayerRG2BGR, true},
                                                {"bayer_gbrg8", CV_8UC1, cv::COLOR_BayerGR2BGR, true},
                                                {"bayer_grbg8", CV_8UC1, cv::COLOR_BayerGB2BGR, true}}};

}  // namespace

const ColorEncoding* find_color_encoding(const std::string& name) {
  const auto* found = std::ranges::find(kEncodings, name, &ColorEncoding::name);
  return found == kEncodings.end() ? nullptr : &*found;
}

std::string color_encodings() {
  std::string names;
  for (const ColorEncoding& encoding : kEncodings)
    names.append(names.empty() ? "" : ", ").append(encoding.name);
  return names;
}

cv::Mat to_bgr(const cv::Mat& pixels, const ColorEncoding& encoding, bool is_big_endian) {
  cv::Mat source = pixels;
  if (pixels.depth() == CV_16U) {
    constexpr double kTo8Bits = 1.0 / 257;  // 65535 is 255
    (is_big_endian ? swapped(pixels) : pixels).convertTo(source, CV_8U, kTo8Bits);
  }
  cv::Mat bgr;
  cv::cvtColor(source, bgr, *encoding.conversion);
  return bgr;
}

cv::Mat swapped(const cv::Mat& values) {
  cv::Mat result = values.clone();
  const std::size_t size = values.elemSize1();
  for (std::uint8_t* value = result.data; value != result.dataend; value += size)
    std::reverse(value, value + size);
  return result;
}

}  // namespace rds::image
