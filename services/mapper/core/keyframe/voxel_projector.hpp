// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "services/mapper/core/keyframe/keyframe_record.hpp"
#include "services/mapper/core/keyframe/voxel_key.hpp"

namespace rds::mapper {

/// Voxel of a point in voxel units (inside the key range).
inline octomap::OcTreeKey key_at(const Eigen::Vector3d& p) {
  return {static_cast<std::uint16_t>(p.x()), static_cast<std::uint16_t>(p.y()),
          static_cast<std::uint16_t>(p.z())};
}

/// Tells where the voxel changes from pixel to pixel: neighbours mostly fall into one, which is looked up
/// once.
class VoxelRun {
 public:
  [[nodiscard]] bool begins_with(const octomap::OcTreeKey& key) {
    return std::exchange(last_, packed(key)) != packed(key);
  }

 private:
  std::uint64_t last_ = 0;  // packed; no key that can hold a point is 0
};

/// Where the octree can hold a point; false for NaN.
inline bool in_key_range(const Eigen::Vector3d& p) {
  constexpr double kLowestKey = 8;
  constexpr double kHighestKey = 65536 - 8;
  const auto fits = [](double x) { return x >= kLowestKey && x < kHighestKey; };
  return fits(p.x()) && fits(p.y()) && fits(p.z());
}

/// Pixels of a keyframe as points in voxel units; far ones and those without return end at
/// max_range_m.
struct VoxelProjector {
  VoxelProjector(const KeyframeRecord& keyframe, double resolution_m, double range_m)
      : record(keyframe),
        rotation(keyframe.map_from_camera.linear() / resolution_m),
        origin(keyframe.map_from_camera.translation() / resolution_m + Eigen::Vector3d::Constant(kKeyOffset)),
        max_range_m(static_cast<float>(range_m)) {}

  /// @param its_class  of the pixel. @return false if it shows no point, or one that the octree cannot hold.
  [[nodiscard]] bool point(std::size_t pixel, PixelClass its_class, Eigen::Vector3d& at) const {
    if (its_class == PixelClass::kInvalid) return false;
    const Eigen::Vector3f& ray = (*record.grid.rays)[pixel];
    if (!(ray.squaredNorm() <= kMaxObliqueness * kMaxObliqueness)) return false;
    const bool measured = its_class != PixelClass::kFar && its_class != PixelClass::kNoReturn;
    const float depth = measured ? record.depth_m(pixel) : max_range_m;
    const double x = double{ray.x()} * double{depth};  // written out: this is where a keyframe's time goes
    const double y = double{ray.y()} * double{depth};
    const double z = double{ray.z()} * double{depth};
    at = {rotation(0, 0) * x + rotation(0, 1) * y + rotation(0, 2) * z + origin.x(),
          rotation(1, 0) * x + rotation(1, 1) * y + rotation(1, 2) * z + origin.y(),
          rotation(2, 0) * x + rotation(2, 1) * y + rotation(2, 2) * z + origin.z()};
    return in_key_range(at);
  }

  static constexpr double kKeyOffset = 32768;  // key of coordinate 0
  static constexpr float kMaxObliqueness = 2;  // a point farther than this × its depth is at the edge of a
                                               // fisheye: left out
  const KeyframeRecord& record;
  Eigen::Matrix3d rotation;
  Eigen::Vector3d origin;
  float max_range_m;
};

}  // namespace rds::mapper
