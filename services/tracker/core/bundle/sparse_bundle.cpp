// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/bundle/sparse_bundle.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "services/tracker/core/bundle/reduced_system.hpp"

namespace rds::tracker {
namespace {

constexpr double kFirstLambda = 1e-4;
constexpr double kLeastLambda = 1e-10;
constexpr double kMostLambda = 1e10;
constexpr double kLeastShare = 1e-3;  // of the expected gain, else the step is taken back
// Of keyframes poses are known to some millimetres: the rest is not worth an iteration.
constexpr double kSettledM = 2e-4;
constexpr double kSettledRad = 1e-4;

void move(const BundleStep& step, SparseBundle& bundle) {
  for (std::size_t c = 0; c < bundle.cameras.size(); ++c) {
    geometry::Pose& pose = bundle.cameras[c].camera_from_map;
    if (!step.cameras[c].isZero(0)) pose = se3_exp(step.cameras[c]) * pose;
  }
  for (std::size_t p = 0; p < bundle.points.size(); ++p) bundle.points[p] += step.points[p];
}

bool is_settled(const BundleStep& step) {
  return std::ranges::all_of(step.cameras, [](const Twist& twist) {
    return twist.head<3>().norm() < kSettledM && twist.tail<3>().norm() < kSettledRad;
  });
}

}  // namespace

bool adjust(SparseBundle& bundle, const SparseBundleOptions& options) {
  ReducedSystem system(bundle);
  double cost = cost_of(bundle, options.is_robust);
  double lambda = kFirstLambda;
  double growth = 2;  // of λ with each step that is taken back
  for (int i = 0; i < options.iterations && lambda < kMostLambda; ++i) {
    if (options.stop.stop_requested()) return false;
    const auto step = system.solve(bundle, options.is_robust, lambda);
    auto cameras = bundle.cameras;
    auto points = bundle.points;
    if (step) move(*step, bundle);
    const double cost_now = cost_of(bundle, options.is_robust);
    const double share = step ? (cost - cost_now) / step->expected_gain : 0;
    if (!(share > kLeastShare)) {
      bundle.cameras = std::move(cameras);
      bundle.points = std::move(points);
      lambda *= growth;
      growth *= 2;
      continue;
    }
    cost = cost_now;
    lambda = std::max(kLeastLambda, lambda * std::max(1.0 / 3, 1 - std::pow(2 * share - 1, 3)));
    growth = 2;
    if (is_settled(*step)) break;
  }
  return !options.stop.stop_requested();
}

}  // namespace rds::tracker
