// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/mapper/core/keyframe/keyframe_record.hpp"

namespace rds::mapper {

/// The rays of the newest camera, made once.
class RayCache {
 public:
  explicit RayCache(int stride_px) : stride_px_(stride_px) {}

  std::shared_ptr<const std::vector<Eigen::Vector3f>> of(const geometry::CameraModel& camera) {
    if (!rays_ || !(camera == camera_)) {
      rays_ = sample_rays(camera, stride_px_);
      camera_ = camera;
    }
    return rays_;
  }

 private:
  int stride_px_;
  geometry::CameraModel camera_;
  std::shared_ptr<const std::vector<Eigen::Vector3f>> rays_;
};

}  // namespace rds::mapper
