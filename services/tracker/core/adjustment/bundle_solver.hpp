// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <stop_token>
#include <vector>

#include "common/geometry/pose.hpp"
#include "services/tracker/core/pose/observation_model.hpp"

namespace rds::tracker {

/// What a camera measured of a point.
struct BundleObservation {
  std::size_t camera = 0;
  Measurement measurement;
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();  // of the weighted residual
};

struct BundlePoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  std::vector<BundleObservation> observations;  // by at least two cameras
};

struct BundleCamera {
  geometry::Pose camera_from_map = geometry::Pose::Identity();
  ObservationModel model;
  bool is_fixed = false;
};

struct Bundle {
  std::vector<BundleCamera> cameras;
  std::vector<BundlePoint> points;
};

struct BundleSolverOptions {
  int iterations = 10;
  bool is_robust = true;  // Huber's loss, with the bounds of χ²
  std::stop_token stop;   // gives up after the present iteration
};

/// Moves cameras and points to where the sum of squared residuals is least: Levenberg's and Marquardt's
/// method, the points eliminated first (Schur), the cameras by a sparse Cholesky factor. No point lies behind
/// a camera that sees it. Ends, too, where an iteration gains next to nothing.
///
/// Single-threaded, the same bits every time. Beside the bundle it keeps 36 numbers for each pair of cameras
/// that see a point together, and nothing for an observation: these are linearised twice.
/// Source: Triggs et al. 2000, §6.1; Hartley & Zisserman 2004, A6.
void solve_bundle(Bundle& bundle, const BundleSolverOptions& options);

}  // namespace rds::tracker
