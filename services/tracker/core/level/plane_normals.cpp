// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/level/plane_normals.hpp"

#include <cmath>
#include <optional>

#include <Eigen/Cholesky>

namespace rds::tracker {
namespace {

constexpr int kWindow = 10;             // cells, some 40 px
constexpr double kLeastMeasured = .85;  // of a window's cells
constexpr double kFarthestM = 6;        // beyond, a window of a Kinect's depth is a few steps
constexpr double kLargestRms = 2;  // of σ: two steps side by side in a window of a true plane

bool shows_static(const DepthView& view, int column, int row) {
  const float z = view.depth_m(row, column);
  return z > 0 && z < kFarthestM && (view.movable.empty() || view.movable(row, column) == 0);
}

/// Least squares of 1/z over rays, with the normal equations of one window.
class InverseDepthFit {
 public:
  void add(const Eigen::Vector3d& ray, double depth_m, const geometry::DepthNoise& noise) {
    const double inverse_depth = 1 / depth_m;
    variances_ += std::pow(noise.sigma_m(depth_m) * inverse_depth * inverse_depth, 2);
    ata_ += ray * ray.transpose();
    atb_ += ray * inverse_depth;
    btb_ += inverse_depth * inverse_depth;
    ++count_;
  }
  [[nodiscard]] int count() const { return count_; }
  /// @return nullopt where the window is no plane.
  [[nodiscard]] std::optional<Eigen::Vector3d> normal() const {
    const Eigen::Vector3d plane = ata_.ldlt().solve(atb_);
    const double squares = btb_ - plane.dot(atb_);
    if (!plane.allFinite() || squares > kLargestRms * kLargestRms * variances_) return std::nullopt;
    return plane.normalized();
  }

 private:
  Eigen::Matrix3d ata_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d atb_ = Eigen::Vector3d::Zero();
  double btb_ = 0;
  double variances_ = 0;
  int count_ = 0;
};

}  // namespace

std::vector<Eigen::Vector3d> plane_normals(const DepthView& view) {
  std::vector<Eigen::Vector3d> normals;
  for (int top = 0; top + kWindow <= view.depth_m.rows; top += kWindow / 2)
    for (int left = 0; left + kWindow <= view.depth_m.cols; left += kWindow / 2) {
      InverseDepthFit fit;
      for (int row = top; row < top + kWindow; ++row)
        for (int column = left; column < left + kWindow; ++column)
          if (shows_static(view, column, row))
            fit.add(view.grid->ray(column, row).cast<double>(), double{view.depth_m(row, column)},
                    view.grid->noise());
      if (fit.count() < kLeastMeasured * kWindow * kWindow) continue;
      if (const auto normal = fit.normal()) normals.push_back(*normal);
    }
  return normals;
}

}  // namespace rds::tracker
