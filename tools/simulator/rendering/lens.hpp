// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core.hpp>

#include "common/geometry/camera_model.hpp"

namespace rds::simulator {

/// Between the picture that is rendered, without distortion, and the one that the camera sees.
class Lens {
 public:
  /// @throws std::invalid_argument if the distortion is so strong that it cannot be inverted in the picture.
  explicit Lens(const geometry::CameraModel& camera);

  /// The camera itself if it has no distortion; else one with the same focal lengths that sees all it sees.
  [[nodiscard]] const geometry::CameraModel& ideal() const { return ideal_; }

  /// Puts what ideal() sees where the camera sees it.
  /// @param interpolation  cv::INTER_LINEAR, or cv::INTER_NEAREST for what cannot be mixed.
  void distort(cv::Mat& picture, int interpolation) const;

 private:
  geometry::CameraModel ideal_;
  cv::Mat from_x_;  // CV_32FC1, per pixel of the camera: where ideal() sees it; empty without distortion
  cv::Mat from_y_;
};

}  // namespace rds::simulator
