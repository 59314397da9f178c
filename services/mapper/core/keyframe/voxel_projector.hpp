// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "services/mapper/core/keyframe/keyframe_record.hpp"
#include "services/mapper/core/keyframe/voxel_key.hpp"

namespace rds::mapper {

/// Tells where the voxel changes from pixel to pixel: neighbours mostly fall into one, which is looked up
/// once.
class VoxelRun {
 public:
  [[nodiscard]] bool begins_with(std::uint64_t packed_key) {
    return std::exchange(last_, packed_key) != packed_key;
  }

 private:
  std::uint64_t last_ = 0;  // no key that can hold a point is 0
};

/// A point in voxel units, and its voxel.
struct VoxelPoint {
  Eigen::Vector4d at;  // the last coordinate means nothing: four are added as fast as three
  std::uint64_t packed_key;

  [[nodiscard]] octomap::OcTreeKey key() const { return unpacked(packed_key); }
};

/// Pixels of a keyframe as points in voxel units; far ones and those without return end at
/// max_range_m.
class VoxelProjector {
 public:
  VoxelProjector(const KeyframeRecord& record, double resolution_m, double range_m)
      : record_(record), max_range_m_(static_cast<float>(range_m)) {
    const Eigen::Matrix3d rotation = record.map_from_camera.linear() / resolution_m;
    for (int axis = 0; axis < 3; ++axis) columns_[axis] << rotation.col(axis), 0;
    origin_ << record.map_from_camera.translation() / resolution_m + Eigen::Vector3d::Constant(kKeyOffset), 0;
    const Eigen::AlignedBox2f& rays = record.grid.rays->extent();
    view_.extend(origin());
    for (const float x : {rays.min().x(), rays.max().x()})
      for (const float y : {rays.min().y(), rays.max().y()})
        view_.extend(at({x, y, 1}, max_range_m_).head<3>());
    for (int axis = 0; axis < 3; ++axis) {
      const auto inside = [&](double at) {
        return static_cast<int>(std::clamp(at, kLowestKey, kHighestKey));
      };
      first_[axis] = inside(view_.min()[axis] - 1);
      last_[axis] = inside(view_.max()[axis] + 2) - 1;
    }
  }

  [[nodiscard]] const KeyframeRecord& record() const { return record_; }
  /// Of the camera.
  [[nodiscard]] Eigen::Vector3d origin() const { return origin_.head<3>(); }
  /// Where the octree can hold the camera.
  [[nodiscard]] bool is_inside() const {
    const auto fits = [](double x) { return x >= kLowestKey && x < kHighestKey; };
    return fits(origin_.x()) && fits(origin_.y()) && fits(origin_.z());
  }
  /// Around camera and points, up to rounding [voxels].
  [[nodiscard]] const Eigen::AlignedBox3d& view() const { return view_; }

  /// @param its_class  of the pixel. @return false if it shows no point, or one that the octree cannot hold.
  [[nodiscard]] bool project(std::size_t pixel, PixelClass its_class, VoxelPoint& point) const {
    const SampledRays& rays = *record_.grid.rays;
    if (its_class == PixelClass::kInvalid || !rays.is_used(pixel)) return false;
    const bool measured = its_class != PixelClass::kFar && its_class != PixelClass::kNoReturn;
    const double depth = measured ? record_.depth_m(pixel) : max_range_m_;
    point.at = at(rays[pixel], depth);
    const Eigen::Array3i key = point.at.head<3>().cast<int>().array();
    point.packed_key = packed({static_cast<std::uint16_t>(key[0]), static_cast<std::uint16_t>(key[1]),
                               static_cast<std::uint16_t>(key[2])});
    return (key >= first_ && key <= last_).all();
  }

 private:
  static constexpr double kKeyOffset = 32768;  // key of coordinate 0
  static constexpr double kLowestKey = 8;
  static constexpr double kHighestKey = 65536 - 8;

  /// @param ray  (x, y, 1).
  [[nodiscard]] Eigen::Vector4d at(const Eigen::Vector3f& ray, double depth) const {
    return columns_[0] * (double{ray.x()} * depth) + columns_[1] * (double{ray.y()} * depth) +
           columns_[2] * depth + origin_;
  }

  const KeyframeRecord& record_;
  std::array<Eigen::Vector4d, 3> columns_;
  Eigen::Vector4d origin_;
  Eigen::AlignedBox3d view_;
  float max_range_m_;
  Eigen::Array3i first_;  // keys that the octree can hold and that are in view
  Eigen::Array3i last_;
};

}  // namespace rds::mapper
