// SPDX-License-Identifier: Apache-2.0
#include "common/image/rgbd_frame.hpp"

#include <cmath>

#include <opencv2/imgproc.hpp>

namespace rds::image {

void ColorImage::to_gray(cv::Mat& gray) const {
  cv::cvtColor(pixels, gray, order == ChannelOrder::kBgr ? cv::COLOR_BGR2GRAY : cv::COLOR_RGB2GRAY);
}

cv::Mat ColorImage::bgr() const {
  if (order == ChannelOrder::kBgr) return pixels;
  cv::Mat bgr;
  cv::cvtColor(pixels, bgr, cv::COLOR_RGB2BGR);
  return bgr;
}

float DepthImage::at(int x, int y) const {
  const float raw =
      values.type() == CV_16UC1 ? static_cast<float>(values.at<std::uint16_t>(y, x)) : values.at<float>(y, x);
  return std::isfinite(raw) && raw > 0 ? raw * metres_per_unit : 0.0F;
}

DepthImage empty_depth(const cv::Size& size) {
  return {.values = cv::Mat::zeros(size, CV_16UC1), .metres_per_unit = 0.001F, .owner = nullptr};
}

}  // namespace rds::image
