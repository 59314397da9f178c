// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <opencv2/core.hpp>

#include "common/image/rgbd_frame.hpp"

namespace rds::doctor {

/// What the colour picture looks like; grey values are 0 … 255.
struct ColorLook {
  double brightness = 0;  // mean grey value
  double contrast = 0;    // its standard deviation
  double sharpness =
      0;  // variance of the Laplacian over the variance of the grey values; 0 for a flat picture
};

/// What the depth picture looks like, from every fourth pixel of every fourth row.
struct DepthLook {
  double measured = 0;  // share of the pixels with a measurement
  double near_m = 0;    // 1st percentile of the measurements, like the next two 0 without any
  double median_m = 0;
  double far_m = 0;          // 99th percentile
  double commonest = 0;      // share of the most frequent value among the measurements
  double commonest_raw = 0;  // that value as it stands in the file
};

struct FrameLook {
  std::int64_t stamp_ns = 0;
  ColorLook color;
  DepthLook depth;
  double color_change = 0;  // mean absolute grey difference to the frame looked at before; NaN for the first
  bool depth_repeated = false;  // every value as in the frame looked at before
};

/// @param picture  CV_8UC1; a wider one than 640 px is looked at shrunk to that.
ColorLook look_at_color(const cv::Mat& picture);
DepthLook look_at_depth(const image::DepthImage& depth);

}  // namespace rds::doctor
