// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/pose/depth_alignment.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "services/tracker/core/motion/se3.hpp"
#include "services/tracker/core/removal/surface_cells.hpp"

namespace rds::tracker {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr Eigen::Index kStride = 4;    // of the points
constexpr int kIterations = 15;        // at most
constexpr double kFirstGateM = 0.2;    // between a point and its surface, 1 m away …
constexpr double kLastGateM = 0.03;    // … in the end
constexpr double kGateShrinks = 0.75;  // per iteration
constexpr double kNoiseM = 0.006;      // of a depth, 1 m away
constexpr double kTrustInMovable = 0.05;
constexpr double kAlike = 50;        // neighbours that err alike
constexpr double kGuessM = 0.03;     // standard deviation of the guess, and …
constexpr double kGuessRad = 0.05;   // … of its rotation
constexpr double kSmallStep = 2e-4;  // m and rad
constexpr int kLeastCompared = 500;
constexpr double kLoosest = 0.05;  // m and rad, standard deviation in the direction that is held least
constexpr double kAgreeing = 0.6;  // of those compared

/// Normal equations of point-to-plane distances.
struct Sums {
  Matrix6d information = Matrix6d::Zero();
  Twist gradient = Twist::Zero();
  int compared = 0;
  int agreeing = 0;
};

void add(const SeenCells& before, double trust, const Eigen::Isometry3f& here_from_before,
         const SurfaceCells& now, double gate_m, Sums& sums) {
  for (Eigen::Index i = 0; i < before.points.rows(); i += kStride) {
    const Eigen::Vector3f p = here_from_before * before.points.row(i).matrix().transpose();
    const cv::Point cell = now.grid.cell_of(p);
    if (cell.x < 0 || !(now.depth_m(cell) > 0)) continue;
    const Eigen::Vector3f normal = now.normal(cell.x, cell.y);
    if (normal.isZero()) continue;
    ++sums.compared;
    const Eigen::Vector3d n = normal.normalized().cast<double>();
    const double r = n.dot((p - now.point(cell.x, cell.y)).cast<double>());
    const double unit_m = std::max(1.0, double{p.z()} * double{p.z()});  // noise grows with depth squared
    const double share = r / (gate_m * unit_m);
    if (std::abs(share) >= 1) continue;
    ++sums.agreeing;
    Twist j;
    j << n, p.cast<double>().cross(n);
    const double weight = trust * std::pow((1 - share * share) / (kNoiseM * unit_m), 2) / kAlike;  // Tukey
    sums.information += weight * j * j.transpose();
    sums.gradient -= weight * r * j;
  }
}

Sums compare(const EarlierView& before, const geometry::Pose& here_from_before, const SurfaceCells& now,
             double gate_m) {
  Sums sums;
  add(before.standing, 1, here_from_before.cast<float>(), now, gate_m, sums);
  add(before.movable, kTrustInMovable, here_from_before.cast<float>(), now, gate_m, sums);
  return sums;
}

}  // namespace

std::optional<geometry::Pose> align_depth(const EarlierView& before, const cv::Mat1f& depth_m,
                                          const GridGeometry& grid, const geometry::Pose& guess) {
  const SurfaceCells now{depth_m, grid};
  const geometry::Pose start = guess * before.standing.map_from_camera;
  Twist trusted;  // information of the guess
  trusted << Eigen::Vector3d::Constant(1 / (kGuessM * kGuessM)),
      Eigen::Vector3d::Constant(1 / (kGuessRad * kGuessRad));
  geometry::Pose here_from_before = start;
  double gate_m = kFirstGateM;
  for (int k = 0; k < kIterations; ++k) {
    Sums sums = compare(before, here_from_before, now, gate_m);
    if (sums.compared < kLeastCompared) return std::nullopt;
    sums.information += trusted.asDiagonal();
    sums.gradient -= trusted.asDiagonal() * se3_log(here_from_before * start.inverse());
    const Twist step = sums.information.ldlt().solve(sums.gradient);
    if (!step.allFinite()) return std::nullopt;
    here_from_before = se3_exp(step) * here_from_before;
    if (gate_m <= kLastGateM && step.norm() < kSmallStep) break;
    gate_m = std::max(kLastGateM, gate_m * kGateShrinks);
  }
  const Sums last = compare(before, here_from_before, now, kLastGateM);
  const double least = Eigen::SelfAdjointEigenSolver<Matrix6d>(last.information).eigenvalues()[0];
  if (last.agreeing < kAgreeing * last.compared || least < 1 / (kLoosest * kLoosest)) return std::nullopt;
  return here_from_before * before.standing.map_from_camera.inverse();
}

}  // namespace rds::tracker
