// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <stop_token>
#include <vector>

#include "services/tracker/core/motion/se3.hpp"
#include "services/tracker/core/pose/observation_model.hpp"

namespace rds::tracker {

/// Many cameras and points, of which each camera sees few.
struct SparseBundle {
  struct Camera {
    geometry::Pose camera_from_map;
    ObservationModel model;
    bool is_fixed = false;
  };
  struct Observation {
    std::uint32_t camera = 0;
    Measurement measurement;
    Eigen::Vector3d shift = Eigen::Vector3d::Zero();  // of the weighted residual
  };
  std::vector<Camera> cameras;
  std::vector<Eigen::Vector3d> points;
  std::vector<std::vector<Observation>> seen;  // of each point; by each camera once at most, and not behind it
};

struct SparseBundleOptions {
  int iterations = 10;
  bool is_robust = true;  // Huber's loss, bounds as ObservationModel::chi2()
  std::stop_token stop;   // gives up after the present iteration
};

/// Moves the cameras that are not fixed, and the points, to where the sum of squared residuals is least:
///
///   min Σ ρ(‖r(T_c, p)‖²),   (H + λ diag H) δ = −g        (Levenberg, Marquardt)
///
/// Points are eliminated first (Schur complement): what is left joins cameras that see the same points, and
/// is solved by a Cholesky factorisation of 6×6 blocks. It ends when no camera moves by more than a
/// fraction of what poses are known to.
/// Source: Triggs et al. 2000, §6; Nielsen 1999 (λ).
/// @return false if it was stopped.
bool adjust(SparseBundle& bundle, const SparseBundleOptions& options);

}  // namespace rds::tracker
