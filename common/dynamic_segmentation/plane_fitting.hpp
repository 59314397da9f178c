// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <vector>

#include <Eigen/Core>

#include "common/geometry/depth_noise.hpp"

namespace rds::segmentation {

/// Points p with normal · p = distance, camera frame [m].
struct BackgroundPlane {
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();
  float distance = 0;
  float narrow_m = 0;  // standard deviation of its samples along its narrower side
};

/// Where a surface is, camera frame [m], and which way it faces: a vector of any length, zero if not known.
struct SurfaceSample {
  Eigen::Vector3f point = Eigen::Vector3f::Zero();
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
};

/// As far as depth is measured right.
inline bool is_near(const BackgroundPlane& plane, const Eigen::Vector3f& point,
                    const geometry::DepthNoise& noise) {
  return std::abs(plane.normal.dot(point) - plane.distance) < noise.plane_tolerance_m(point.z());
}

/// As far as is known.
inline bool is_parallel(const BackgroundPlane& plane, const Eigen::Vector3f& normal) {
  constexpr float kMinCosine = 0.8F;
  const float along = normal.dot(plane.normal);
  return along * along >= kMinCosine * kMinCosine * normal.squaredNorm();
}

/// Large planes among samples, found by RANSAC, the largest first. The same samples give the same planes.
std::vector<BackgroundPlane> fit_planes(std::vector<SurfaceSample> samples,
                                        const geometry::DepthNoise& noise);

}  // namespace rds::segmentation
