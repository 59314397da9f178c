// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "common/geometry/camera_model.hpp"
#include "common/image/rgbd_frame.hpp"
#include "services/tracker/core/features/feature.hpp"

namespace rds::tracker {

/// The features of one picture with a grid for look-up by place. Immutable once built; shared by frame,
/// keyframe and mapping jobs.
class FeatureSet {
 public:
  FeatureSet() = default;
  /// @param features  with undistorted px; those not matchable are kept but never found by look-up.
  FeatureSet(const geometry::CameraModel& camera, std::vector<Feature> features);

  [[nodiscard]] const geometry::CameraModel& camera() const { return camera_; }
  [[nodiscard]] const std::vector<Feature>& all() const { return features_; }
  [[nodiscard]] const Feature& operator[](std::size_t i) const { return features_[i]; }
  [[nodiscard]] std::size_t size() const { return features_.size(); }

  /// True if any feature has depth.
  [[nodiscard]] bool has_depth() const {
    return std::ranges::any_of(features_, [](const Feature& f) { return f.depth_m > 0; });
  }
  /// Point of feature i in the camera frame [m]; NaN without depth.
  [[nodiscard]] Eigen::Vector3d point_in_camera(std::size_t i) const;

  /// True if an undistorted pixel lies where features can be.
  [[nodiscard]] bool sees(const Eigen::Vector2d& px) const;

  /// Calls `visit(index)` for every feature within a square of half side `radius_px` around px, at a level
  /// from min_level to max_level, in a fixed order.
  template <class Visit>
  void for_each_near(const Eigen::Vector2f& px, float radius_px, int min_level, int max_level,
                     Visit visit) const {
    const int c0 = column(px.x() - radius_px);
    const int c1 = column(px.x() + radius_px);
    const int r1 = row(px.y() + radius_px);
    for (int r = row(px.y() - radius_px); r <= r1; ++r)
      for (std::uint32_t k = cell_begin_[cell(c0, r)]; k < cell_begin_[cell(c1, r) + 1]; ++k) {
        const Feature& f = features_[cell_items_[k]];
        if (f.level >= min_level && f.level <= max_level && std::abs(f.px.x() - px.x()) < radius_px &&
            std::abs(f.px.y() - px.y()) < radius_px)
          visit(cell_items_[k]);
      }
  }

 private:
  static constexpr int kColumns = 64;
  static constexpr int kRows = 48;

  [[nodiscard]] static std::size_t cell(int c, int r) { return static_cast<std::size_t>(r * kColumns + c); }
  [[nodiscard]] int column(float x) const;
  [[nodiscard]] int row(float y) const;

  geometry::CameraModel camera_;
  std::vector<Feature> features_;
  Eigen::Vector2f lowest_ = Eigen::Vector2f::Zero();   // corner of the undistorted picture
  Eigen::Vector2f highest_ = Eigen::Vector2f::Zero();  // opposite corner
  Eigen::Vector2f cells_per_px_ = Eigen::Vector2f::Zero();
  std::vector<std::uint32_t> cell_begin_ = std::vector<std::uint32_t>(kColumns * kRows + 1);
  std::vector<std::uint32_t> cell_items_;
};

/// Depth [m] at a place in the picture, of the nearer surface at an edge; 0 without measurement or beyond
/// max_depth_m.
float depth_at(const image::DepthImage& depth, const Eigen::Vector2f& image_px, double max_depth_m);

/// Undistorts features and gives them depth, but for those that are not matchable.
void complete_features(const geometry::CameraModel& camera, const image::DepthImage& depth,
                       double max_depth_m, std::vector<Feature>& features);

}  // namespace rds::tracker
