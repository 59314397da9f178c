// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

#include <opencv2/core.hpp>

#include "common/geometry/camera_model.hpp"
#include "common/geometry/pose.hpp"
#include "common/image/rgbd_frame.hpp"

namespace rds::image {

/// What a moving depth camera would have measured a moment before or after it did.
///
/// Each pixel looks where its ray met the surface in the picture that was taken: first as if the camera had
/// only turned, then by the depth found there with what it moved. For motions of a few degrees and
/// centimetres; what comes into view is not measured, an edge may be a pixel off.
class DepthMotion {
 public:
  /// Calls part(0) … part(count − 1), also at the same time.
  using Execute = std::function<void(std::size_t count, const std::function<void(std::size_t)>& part)>;

  explicit DepthMotion(const geometry::CameraModel& camera);

  /// @param picture          CV_16UC1 or CV_32FC1 of the camera's size, else std::invalid_argument is thrown.
  /// @param taken_from_here  from the camera at the moment asked for to where it took the picture.
  /// @return of the same size, type and unit; the picture itself where nothing moves by half a pixel.
  [[nodiscard]] DepthImage moved(const DepthImage& picture, const geometry::Pose& taken_from_here,
                                 const Execute& execute) const;

  [[nodiscard]] const geometry::CameraModel& camera() const { return camera_; }

 private:
  [[nodiscard]] cv::Mat4f turned(const geometry::Pose& taken_from_here) const;

  geometry::CameraModel camera_;
  cv::Mat3f rays_;  // of the corners of squares of pixels
};

}  // namespace rds::image
