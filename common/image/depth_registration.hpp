// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core.hpp>

#include "common/geometry/lens.hpp"
#include "common/geometry/pose.hpp"
#include "common/image/rgbd_frame.hpp"

namespace rds::image {

/// Registers depth pictures of one camera to another that stands elsewhere: every measurement becomes a
/// point, is moved into the target's frame and drawn there. Of several in one pixel the nearest is seen
/// (z-buffer); what only the target sees has no measurement.
///
/// A measurement is drawn a quarter wider than its pixel is in the target's picture (DepthFootprints): so a
/// surface has no holes where depth is coarser than the target, or where it slopes by up to some 80°, and the
/// edges of what is near are off by no more than they are in the source.
/// The rays of the source's pixels are computed once.
class DepthRegistration {
 public:
  DepthRegistration(const geometry::Lens& source, const geometry::CameraModel& target);

  /// @param picture  CV_16UC1 or CV_32FC1 of the source's size, else std::invalid_argument is thrown.
  /// @return of the target's size, in the type and unit of `picture`.
  [[nodiscard]] DepthImage depth(const DepthImage& picture, const geometry::Pose& target_from_source) const;

  [[nodiscard]] const geometry::Lens& source() const { return source_; }
  [[nodiscard]] const geometry::CameraModel& target() const { return target_; }

 private:
  geometry::Lens source_;
  geometry::CameraModel target_;
  // Of the source's pixels: rays (x, y, 1), and half of the distance to the next ray; 0: the lens has no ray.
  cv::Mat1f ray_x_;
  cv::Mat1f ray_y_;
  cv::Mat1f half_;
};

}  // namespace rds::image
