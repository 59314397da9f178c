// SPDX-License-Identifier: Apache-2.0
#include "services/detector/core/input_transform.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace rds::detector {
namespace {

/// Channel c of the 1×3×H×W tensor as an H×W picture.
cv::Mat plane(cv::Mat& tensor, int c, const InputDescription& input) {
  return {input.height, input.width, CV_32F, tensor.ptr<float>(0, c)};
}

}  // namespace

geometry::Box2 InputTransform::to_picture(const geometry::Box2& box) const {
  return {(box.x0 - offset_x) / scale_x, (box.y0 - offset_y) / scale_y, (box.x1 - offset_x) / scale_x,
          (box.y1 - offset_y) / scale_y};
}

InputTransform place_picture(const InputDescription& input, int width, int height) {
  if (input.resize == Resize::kStretch)
    return {static_cast<double>(input.width) / width, static_cast<double>(input.height) / height, 0, 0};
  const double scale =
      std::min(static_cast<double>(input.width) / width, static_cast<double>(input.height) / height);
  const double w = std::clamp(std::round(width * scale), 1.0, static_cast<double>(input.width));
  const double h = std::clamp(std::round(height * scale), 1.0, static_cast<double>(input.height));
  InputTransform place{w / width, h / height, 0, 0};
  if (input.resize == Resize::kCentredLetterbox) {
    place.offset_x = std::floor((input.width - w) / 2);
    place.offset_y = std::floor((input.height - h) / 2);
  }
  return place;
}

cv::Mat make_input(const InputDescription& input, const InputTransform& place,
                   const image::ColorImage& picture) {
  const cv::Size size(static_cast<int>(std::lround(picture.pixels.cols * place.scale_x)),
                      static_cast<int>(std::lround(picture.pixels.rows * place.scale_y)));
  cv::Mat canvas(input.height, input.width, CV_8UC3, cv::Scalar::all(input.pad_value));
  cv::Mat inside =
      canvas(cv::Rect(cv::Point(static_cast<int>(place.offset_x), static_cast<int>(place.offset_y)), size));
  cv::resize(picture.pixels, inside, size, 0, 0, cv::INTER_LINEAR);
  std::array<cv::Mat, 3> channels;
  cv::split(canvas, channels.data());
  const bool same_order = (picture.order == image::ChannelOrder::kBgr) == (input.order == InputOrder::kBgr);
  if (!same_order) std::swap(channels[0], channels[2]);
  const std::array<int, 4> shape{1, 3, input.height, input.width};
  cv::Mat tensor(4, shape.data(), CV_32F);
  for (int c = 0; c < 3; ++c) {
    const auto i = static_cast<std::size_t>(c);
    cv::Mat target = plane(tensor, c, input);
    channels[i].convertTo(target, CV_32F, 1 / input.deviation[i], -input.mean[i] / input.deviation[i]);
  }
  return tensor;
}

}  // namespace rds::detector
