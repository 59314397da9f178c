// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include <opencv2/imgproc.hpp>

#include "common/messages/image_conversions.hpp"
#include "rds_msgs/msg/KeyFrameImages.h"

namespace rds::keyframe_codec::test {

/// Depth [mm] of a slope with a hole, noise, and the smallest and largest values.
inline cv::Mat1w example_depth(cv::Size size) {
  cv::Mat1w depth(size);
  cv::RNG random(1);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      depth(y, x) = static_cast<std::uint16_t>(1000 + 7 * y + 2 * x + random.uniform(0, 5));
  depth(cv::Rect(size.width / 4, size.height / 4, size.width / 2, size.height / 2)) = 0;
  depth(0, 0) = 65535;
  depth(size.height - 1, size.width - 1) = 65535;
  if (size.width > 1) depth(0, 1) = 0;
  return depth;
}

/// Smooth shades with a few edges, as a camera sees a room.
inline cv::Mat3b example_color(cv::Size size) {
  cv::Mat3b color(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      color(y, x) = {cv::saturate_cast<std::uint8_t>(40 + x), cv::saturate_cast<std::uint8_t>(90 + y),
                     cv::saturate_cast<std::uint8_t>(200 - (x + y) / 2)};
  cv::rectangle(color, cv::Rect(size.width / 3, size.height / 3, size.width / 3, size.height / 2),
                {30, 60, 140}, cv::FILLED);
  return color;
}

/// The same pixels in rows with padding that is not zero.
inline cv::Mat with_padding(const cv::Mat& pixels, int columns) {
  cv::Mat wide(pixels.rows, pixels.cols + columns, pixels.type(), cv::Scalar::all(77));
  cv::Mat inside = wide.colRange(0, pixels.cols);
  pixels.copyTo(inside);
  return inside;
}

inline rds_msgs::msg::KeyFrameImages example_keyframe(cv::Size size = {64, 48}) {
  const auto header = messages::make_header(1'500'000'000, "camera_color_optical_frame");
  rds_msgs::msg::KeyFrameImages keyframe;
  keyframe.header(header);
  keyframe.instance(11);
  keyframe.map_epoch(12);
  keyframe.keyframe_id(13);
  keyframe.frame_index(14);
  keyframe.map_from_camera().position().x(1.5);
  keyframe.map_from_camera().orientation().w(1);
  keyframe.camera_info().width(static_cast<std::uint32_t>(size.width));
  keyframe.camera_info().height(static_cast<std::uint32_t>(size.height));
  keyframe.color(messages::to_image_message(
      image::ColorImage{example_color(size), image::ChannelOrder::kBgr, nullptr}, header));
  keyframe.depth(messages::to_image_message(image::DepthImage{example_depth(size), 0.001F, nullptr}, header));
  cv::Mat1b movable((size.height + 1) / 2, (size.width + 1) / 2, std::uint8_t{0});
  movable(0, 0) = 255;
  movable(movable.rows - 1, movable.cols - 1) = 1;
  keyframe.movable(messages::to_image_message(movable, header));
  return keyframe;
}

}  // namespace rds::keyframe_codec::test
