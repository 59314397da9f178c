// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core.hpp>

#include "common/geometry/lens.hpp"
#include "common/image/rgbd_frame.hpp"

namespace rds::image {

/// Resamples pictures of one camera to those of another with the same optical centre and axes: without the
/// distortion of its lens, or at another size. Where a pixel comes from is computed once.
class LensTable {
 public:
  LensTable(const geometry::Lens& source, const geometry::CameraModel& target);

  /// Interpolated; black where the source shows nothing.
  [[nodiscard]] ColorImage color(const ColorImage& picture) const;
  /// The nearest measurement, as between those of two surfaces there is none; 0 where the source shows
  /// nothing.
  [[nodiscard]] DepthImage depth(const DepthImage& picture) const;

  [[nodiscard]] const geometry::Lens& source() const { return source_; }
  [[nodiscard]] const geometry::CameraModel& target() const { return target_; }

 private:
  geometry::Lens source_;
  geometry::CameraModel target_;
  cv::Mat places_;     // CV_16SC2, whole pixels of the source, and …
  cv::Mat fractions_;  // CV_16UC1, as cv::convertMaps() writes them
  cv::Mat nearest_;    // CV_16SC2
};

}  // namespace rds::image
