// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/features/feature_set.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rds::tracker {

FeatureSet::FeatureSet(const geometry::CameraModel& camera, std::vector<Feature> features)
    : camera_(camera), features_(std::move(features)) {
  lowest_.setConstant(std::numeric_limits<float>::max());
  highest_.setConstant(std::numeric_limits<float>::lowest());
  for (const double x : {0.0, camera.width / 2.0, camera.width - 1.0})
    for (const double y : {0.0, camera.height / 2.0, camera.height - 1.0}) {
      const Eigen::Vector2f px = camera.undistort({x, y}).cast<float>();
      lowest_ = lowest_.cwiseMin(px);
      highest_ = highest_.cwiseMax(px);
    }
  cells_per_px_ = Eigen::Vector2f(kColumns, kRows).cwiseQuotient((highest_ - lowest_).cwiseMax(1.0F));
  std::vector<std::size_t> place(features_.size());
  for (std::size_t i = 0; i < features_.size(); ++i) {
    if (!features_[i].matchable) continue;
    place[i] = cell(column(features_[i].px.x()), row(features_[i].px.y()));
    ++cell_begin_[place[i] + 1];
  }
  for (std::size_t c = 1; c < cell_begin_.size(); ++c) cell_begin_[c] += cell_begin_[c - 1];
  cell_items_.resize(cell_begin_.back());
  std::vector<std::uint32_t> next(cell_begin_.begin(), cell_begin_.end() - 1);
  for (std::size_t i = 0; i < features_.size(); ++i)
    if (features_[i].matchable) cell_items_[next[place[i]]++] = static_cast<std::uint32_t>(i);
}

int FeatureSet::column(float x) const {
  return static_cast<int>(std::clamp((x - lowest_.x()) * cells_per_px_.x(), 0.0F, kColumns - 1.0F));
}

int FeatureSet::row(float y) const {
  return static_cast<int>(std::clamp((y - lowest_.y()) * cells_per_px_.y(), 0.0F, kRows - 1.0F));
}

Eigen::Vector3d FeatureSet::point_in_camera(std::size_t i) const {
  const Feature& f = features_[i];
  if (!(f.depth_m > 0)) return Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  return camera_.ray_of_undistorted(f.px.cast<double>()) * static_cast<double>(f.depth_m);
}

bool FeatureSet::sees(const Eigen::Vector2d& px) const {
  const Eigen::Vector2f p = px.cast<float>();
  return p.x() >= lowest_.x() && p.x() <= highest_.x() && p.y() >= lowest_.y() && p.y() <= highest_.y();
}

namespace {

/// Depth at a pixel; at an edge, where surfaces meet, of the one in front: it is its outline that shows.
float nearer_surface(const image::DepthImage& depth, int x, int y) {
  constexpr float kEdge = 0.03F;  // of the depth
  float least = std::numeric_limits<float>::max();
  float largest = 0;
  for (int v = std::max(0, y - 1); v <= std::min(depth.values.rows - 1, y + 1); ++v)
    for (int u = std::max(0, x - 1); u <= std::min(depth.values.cols - 1, x + 1); ++u)
      if (const float z = depth.at(u, v); z > 0) {
        least = std::min(least, z);
        largest = std::max(largest, z);
      }
  return largest > (1 + kEdge) * least ? least : depth.at(x, y);
}

}  // namespace

float depth_at(const image::DepthImage& depth, const Eigen::Vector2f& image_px, double max_depth_m) {
  const int x = std::clamp(static_cast<int>(std::lround(image_px.x())), 0, depth.values.cols - 1);
  const int y = std::clamp(static_cast<int>(std::lround(image_px.y())), 0, depth.values.rows - 1);
  const float z = nearer_surface(depth, x, y);
  return z > static_cast<float>(max_depth_m) ? 0 : z;
}

void complete_features(const geometry::CameraModel& camera, const image::DepthImage& depth,
                       double max_depth_m, std::vector<Feature>& features) {
  for (Feature& f : features) {
    if (f.movable && !f.matchable) continue;
    f.depth_m = depth_at(depth, f.image_px, max_depth_m);
    const Eigen::Vector2d px = camera.undistort(f.image_px.cast<double>());
    if (px.allFinite()) f.px = px.cast<float>();
  }
}

}  // namespace rds::tracker
