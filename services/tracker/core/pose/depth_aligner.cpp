// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/pose/depth_aligner.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "services/tracker/core/motion/se3.hpp"
#include "common/dynamic_segmentation/surfaces.hpp"

namespace rds::tracker {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr Eigen::Index kStride = 4;    // of the points
constexpr int kIterations = 15;        // at most
// Gates between a point and its surface, in standard deviations of their distance.
constexpr double kFirstGate = 33;      // as far as a guess is wrong: 0.2 m, for a Kinect 1 m away
constexpr double kLastGate = 5;        // Tukey's constant, 4.7, as a round number
constexpr double kGateShrinks = 0.75;  // per iteration
constexpr double kMovableWeight = 0.05;
constexpr double kCorrelated = 50;    // neighbouring points have the same errors: so many tell as much as one
constexpr double kGuessM = 0.03;      // standard deviations of the guess: its translation …
constexpr double kGuessRad = 0.05;    // … and its rotation
constexpr double kSmallStep = 2e-4;   // m and rad
constexpr int kMinCompared = 500;     // points
constexpr double kMaxSigma = 0.05;    // m and rad, of the pose in its least certain direction
constexpr double kMinAgreeing = 0.6;  // of the points compared

/// Standard deviation of the distance between a point and the surface that it is of.
double distance_sigma_m(const geometry::DepthNoise& noise, double depth_m) {
  constexpr double kBendM = 0.003;  // of a surface within a cell
  constexpr double kSigmas = 3;     // two depths, √2, each the nearest of four pixels, which is off by one σ
  return std::hypot(kBendM, kSigmas * noise.sigma_m(depth_m));
}

/// Normal equations of point-to-plane distances.
struct Sums {
  Matrix6d information = Matrix6d::Zero();
  Twist gradient = Twist::Zero();
  int compared = 0;
  int agreeing = 0;
};

void add(const segmentation::SeenCells& before, double weight, const Eigen::Isometry3f& here_from_before,
         const segmentation::SurfaceCells& now, double gate, Sums& sums) {
  for (Eigen::Index i = 0; i < before.points.rows(); i += kStride) {
    const Eigen::Vector3f p = here_from_before * before.points.row(i).matrix().transpose();
    const cv::Point cell = now.grid.cell_of(p);
    if (cell.x < 0 || !(now.depth_m(cell) > 0)) continue;
    const Eigen::Vector3f normal = now.normal(cell.x, cell.y);
    if (normal.isZero()) continue;
    ++sums.compared;
    const Eigen::Vector3d n = normal.normalized().cast<double>();
    const double r = n.dot((p - now.point(cell.x, cell.y)).cast<double>());
    const double sigma_m = distance_sigma_m(now.grid.noise(), double{p.z()});
    const double share = r / (gate * sigma_m);
    if (std::abs(share) >= 1) continue;
    ++sums.agreeing;
    Twist j;
    j << n, p.cast<double>().cross(n);
    const double tukey = weight * std::pow((1 - share * share) / sigma_m, 2) / kCorrelated;
    sums.information += tukey * j * j.transpose();
    sums.gradient -= tukey * r * j;
  }
}

Sums compare(const EarlierView& before, const geometry::Pose& here_from_before,
             const segmentation::SurfaceCells& now, double gate) {
  Sums sums;
  add(before.fixed, 1, here_from_before.cast<float>(), now, gate, sums);
  add(before.movable, kMovableWeight, here_from_before.cast<float>(), now, gate, sums);
  return sums;
}

}  // namespace

std::optional<geometry::Pose> align_depth(const EarlierView& before, const cv::Mat1f& depth_m,
                                          const segmentation::GridGeometry& grid,
                                          const geometry::Pose& guess) {
  const segmentation::SurfaceCells now{depth_m, grid};
  const geometry::Pose start = guess * before.fixed.map_from_camera;
  Twist prior;  // information of the guess
  prior << Eigen::Vector3d::Constant(1 / (kGuessM * kGuessM)),
      Eigen::Vector3d::Constant(1 / (kGuessRad * kGuessRad));
  geometry::Pose here_from_before = start;
  double gate = kFirstGate;
  for (int k = 0; k < kIterations; ++k) {
    Sums sums = compare(before, here_from_before, now, gate);
    if (sums.compared < kMinCompared) return std::nullopt;
    sums.information += prior.asDiagonal();
    sums.gradient -= prior.asDiagonal() * se3_log(here_from_before * start.inverse());
    const Twist step = sums.information.ldlt().solve(sums.gradient);
    if (!step.allFinite()) return std::nullopt;
    here_from_before = se3_exp(step) * here_from_before;
    if (gate <= kLastGate && step.norm() < kSmallStep) break;
    gate = std::max(kLastGate, gate * kGateShrinks);
  }
  const Sums last = compare(before, here_from_before, now, kLastGate);
  const double least = Eigen::SelfAdjointEigenSolver<Matrix6d>(last.information).eigenvalues()[0];
  if (last.agreeing < kMinAgreeing * last.compared || least < 1 / (kMaxSigma * kMaxSigma))
    return std::nullopt;
  return here_from_before * before.fixed.map_from_camera.inverse();
}

std::optional<geometry::Pose> DepthAligner::estimate(const DepthView& view,
                                                     const geometry::Pose& guess) const {
  const segmentation::GridGeometry& grid = *view.grid;
  if (!previous_ || previous_->camera != grid.camera()) return std::nullopt;
  const auto& [depth_m, movable, camera, map_from_camera] = *previous_;
  const cv::Mat1b is_static =
      movable.empty() ? cv::Mat1b(grid.size(), std::uint8_t{255}) : cv::Mat1b(movable == 0);
  const EarlierView before{{depth_m, movable, grid, map_from_camera},
                           {depth_m, is_static, grid, map_from_camera}};
  return align_depth(before, view.depth_m, grid, guess);
}

void DepthAligner::set_previous(const DepthView& view, const geometry::Pose& map_from_camera) {
  previous_ = Previous{view.depth_m, view.movable, view.grid->camera(), map_from_camera};
}

}  // namespace rds::tracker
