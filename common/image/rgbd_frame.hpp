// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include <opencv2/core.hpp>

#include "common/geometry/camera_model.hpp"

namespace rds::image {

enum class ChannelOrder { kBgr, kRgb };

/// 8-bit three-channel picture; `pixels` may point into memory that `owner` keeps alive (no copy of a
/// message).
struct ColorImage {
  cv::Mat pixels;  // CV_8UC3
  ChannelOrder order = ChannelOrder::kBgr;
  std::shared_ptr<const void> owner;

  /// A grey copy (CV_8UC1), written into `gray` so that its buffer is reused.
  void to_gray(cv::Mat& gray) const;
  /// The picture in BGR order; shares the pixels when it already is.
  [[nodiscard]] cv::Mat bgr() const;
};

/// Depth along the optical axis, registered to the colour picture: CV_16UC1 or CV_32FC1 times
/// `metres_per_unit`.
struct DepthImage {
  cv::Mat values;
  float metres_per_unit = 0.001F;
  std::shared_ptr<const void> owner;

  /// Depth [m] at integer pixel (x, y) inside the image; 0 where there is no measurement.
  [[nodiscard]] float at(int x, int y) const;
};

/// A depth picture without any measurement.
DepthImage empty_depth(const cv::Size& size);

/// One colour picture and the depth picture that belongs to it.
struct RgbdFrame {
  std::int64_t stamp_ns = 0;  // of the colour picture
  ColorImage color;
  DepthImage depth;
  geometry::CameraModel camera;
};

}  // namespace rds::image
