// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/level/up_direction.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

namespace rds::tracker {
namespace {

using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180;
constexpr double kSigma = 3 * kDegree;  // of a window's normal about its surface's
constexpr double kShare = .4;           // of level surfaces, and of upright ones; the rest may be anything
constexpr double kTiltSigma = 25 * kDegree;  // of the camera
constexpr double kMaxTilt = 60 * kDegree;
constexpr double kPriorWeight = .02;  // against all normals: neighbours tell of the same surface
constexpr std::size_t kFewest = 20;   // windows
constexpr std::size_t kSamples = 40;  // normals that candidates are made of …
constexpr std::size_t kJudges = 200;  // … and judged by
constexpr double kApart = .8;         // sine of the angle between two normals with a sound cross product
constexpr int kRounds = 6;            // of refinement; it gains less than .01° by then
constexpr double kLeastShare = .02;   // of all surfaces, that have to hold a direction

const Vector3d kCameraUp = -Vector3d::UnitY();

/// What a normal may belong to, with probability densities on the sphere.
struct Membership {
  double level = 0;
  double upright = 0;
  double other = (1 - 2 * kShare) / (4 * kPi);

  Membership(const Vector3d& normal, const Vector3d& up) {
    const double cosine = std::min(1.0, std::abs(normal.dot(up)));
    const double from_up = std::acos(cosine) / kSigma;
    const double from_level = std::asin(cosine) / kSigma;
    // Two caps; a band of length 2π.
    level = kShare / 2 / (2 * kPi * kSigma * kSigma) * std::exp(-from_up * from_up / 2);
    upright = kShare / (2 * kPi * std::sqrt(2 * kPi) * kSigma) * std::exp(-from_level * from_level / 2);
  }
  [[nodiscard]] double sum() const { return level + upright + other; }
};

double log_posterior(std::span<const Vector3d> normals, const Vector3d& up) {
  double sum = 0;
  for (const Vector3d& normal : normals) sum += std::log(Membership(normal, up).sum());
  const double tilt = std::acos(std::clamp(up.dot(kCameraUp), -1.0, 1.0)) / kTiltSigma;
  return sum / static_cast<double>(normals.size()) - kPriorWeight * tilt * tilt / 2;
}

/// At most so many, evenly spread.
std::vector<Vector3d> some_of(std::span<const Vector3d> normals, std::size_t most) {
  std::vector<Vector3d> some;
  const std::size_t step = (normals.size() + most - 1) / most;
  for (std::size_t i = 0; i < normals.size(); i += step) some.push_back(normals[i]);
  return some;
}

/// Directions near the camera's up that some of the normals agree with.
std::vector<Vector3d> candidates(std::span<const Vector3d> normals) {
  std::vector<Vector3d> found{kCameraUp};
  const auto consider = [&](Vector3d up) {
    if (up.dot(kCameraUp) < 0) up = -up;
    if (up.dot(kCameraUp) > std::cos(kMaxTilt)) found.push_back(up);
  };
  const std::vector<Vector3d> samples = some_of(normals, kSamples);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    consider(samples[i]);
    const Vector3d along = kCameraUp - kCameraUp.dot(samples[i]) * samples[i];
    if (along.norm() > .5) consider(along.normalized());
    for (std::size_t j = 0; j < i; ++j) {
      const Vector3d edge = samples[i].cross(samples[j]);
      if (edge.norm() > kApart) consider(edge.normalized());
    }
  }
  return found;
}

/// One step of expectation and maximisation, and what the surfaces are with the direction before.
/// @return how firmly they hold it in the direction in which they hold it least, per surface.
double refine(std::span<const Vector3d> normals, UpDirection& direction) {
  Eigen::Matrix<double, 3, 2> tangent;
  tangent.col(0) = direction.up.unitOrthogonal();
  tangent.col(1) = direction.up.cross(tangent.col(0));
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
  direction.level = direction.upright = 0;
  for (const Vector3d& normal : normals) {
    const Membership in(normal, direction.up);
    const double level = in.level / in.sum();
    const double upright = in.upright / in.sum();
    const double along = normal.dot(direction.up);
    const Eigen::Vector2d across = tangent.transpose() * normal;
    information += level * Eigen::Matrix2d::Identity() + upright * across * across.transpose();
    gradient += (along < 0 ? -level : level) * across - upright * along * across;
    direction.level += level;
    direction.upright += upright;
  }
  const auto count = static_cast<double>(normals.size());
  direction.level /= count;
  direction.upright /= count;
  const double weakest = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(information).eigenvalues()[0] / count;
  information += 1e-3 * count * Eigen::Matrix2d::Identity();  // stays where nothing holds it
  direction.up = (direction.up + tangent * information.inverse() * gradient).normalized();
  return weakest;
}

}  // namespace

UpDirection find_up(std::span<const Vector3d> normals) {
  UpDirection direction;
  direction.surfaces = static_cast<int>(normals.size());
  if (normals.size() < kFewest) return direction;
  const std::vector<Vector3d> judges = some_of(normals, kJudges);
  double best = -std::numeric_limits<double>::infinity();
  for (const Vector3d& candidate : candidates(normals)) {
    const double value = log_posterior(judges, candidate);
    if (value <= best) continue;
    best = value;
    direction.up = candidate;
  }
  for (int round = 0; round < kRounds; ++round) direction.is_seen = refine(normals, direction) > kLeastShare;
  return direction;
}

}  // namespace rds::tracker
