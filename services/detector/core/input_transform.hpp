// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core.hpp>

#include "common/geometry/box.hpp"
#include "common/image/rgbd_frame.hpp"
#include "services/detector/core/network_description.hpp"

namespace rds::detector {

/// Where a picture lies in the network's input: input_px = picture_px · scale + offset, per axis.
struct InputTransform {
  double scale_x = 1;
  double scale_y = 1;
  double offset_x = 0;  // [px] of the input
  double offset_y = 0;

  /// An input box [px of the input] in the picture [px], not clipped.
  [[nodiscard]] geometry::Box2 to_picture(const geometry::Box2& box) const;
};

/// Places a picture of the given size; the scale is that of the picture as really resized, whole pixels of
/// the input.
InputTransform place_picture(const InputDescription& input, int width, int height);

/// The network's input tensor 1×3×height×width (CV_32F) for a picture placed by `place`.
cv::Mat make_input(const InputDescription& input, const InputTransform& place,
                   const image::ColorImage& picture);

}  // namespace rds::detector
