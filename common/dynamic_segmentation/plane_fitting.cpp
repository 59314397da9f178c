// SPDX-License-Identifier: Apache-2.0
#include "common/dynamic_segmentation/plane_fitting.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

namespace rds::segmentation {
namespace {

constexpr int kMaxPlanes = 4;
constexpr int kHypotheses = 40;
constexpr std::size_t kMinSamples = 60;  // of a plane
constexpr std::size_t kMaxAsked = 300;   // samples that judge a hypothesis
constexpr std::size_t kNear = 12;        // of the samples in order, that a hypothesis is made of
constexpr float kNarrowM = 0.06F;  // standard deviation along the narrower side: a strip of 0.2 m
constexpr float kMinSine = 0.2F;   // of the triangle that makes a hypothesis

bool agrees(const BackgroundPlane& plane, const SurfaceSample& sample, const geometry::DepthNoise& noise) {
  return is_near(plane, sample.point, noise) && is_parallel(plane, sample.normal);
}

/// Numbers that only look random.
class Sequence {
 public:
  std::size_t below(std::size_t bound) {
    state_ = state_ * 6364136223846793005U + 1442695040888963407U;
    return static_cast<std::size_t>(state_ >> 33U) % bound;
  }

 private:
  std::uint64_t state_ = 1;
};

std::optional<BackgroundPlane> plane_through(const std::array<Eigen::Vector3f, 3>& p) {
  const Eigen::Vector3f a = p[1] - p[0];
  const Eigen::Vector3f b = p[2] - p[0];
  const Eigen::Vector3f normal = a.cross(b);
  if (!(normal.norm() > kMinSine * a.norm() * b.norm())) return std::nullopt;
  const Eigen::Vector3f unit = normal.normalized();
  return BackgroundPlane{unit, unit.dot(p[0]), 0};
}

/// The plane that fits best; nullopt for a strip, which an arm or a leg can be.
std::optional<BackgroundPlane> fit(const std::vector<SurfaceSample>& samples) {
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();
  for (const SurfaceSample& s : samples) mean += s.point;
  mean /= static_cast<float>(samples.size());
  Eigen::Matrix3f scatter = Eigen::Matrix3f::Zero();
  for (const SurfaceSample& s : samples) scatter += (s.point - mean) * (s.point - mean).transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
  solver.computeDirect(scatter);
  const Eigen::Vector3f normal = solver.eigenvectors().col(0);
  const float narrow_m = std::sqrt(solver.eigenvalues()(1) / static_cast<float>(samples.size()));
  if (narrow_m < kNarrowM) return std::nullopt;
  return BackgroundPlane{normal, normal.dot(mean), narrow_m};
}

/// Every so many of the samples that agree with the plane; fewer if they cannot be more than `most`.
std::size_t agreeing(const std::vector<SurfaceSample>& samples, std::size_t stride,
                     const BackgroundPlane& plane, const geometry::DepthNoise& noise, std::size_t most) {
  std::size_t may_agree = (samples.size() + stride - 1) / stride;
  for (std::size_t i = 0; i < samples.size() && may_agree > most; i += stride)
    may_agree -= agrees(plane, samples[i], noise) ? 0 : 1;
  return may_agree;
}

std::optional<BackgroundPlane> best_plane(const std::vector<SurfaceSample>& samples,
                                          const geometry::DepthNoise& noise, Sequence& sequence) {
  std::optional<BackgroundPlane> best;
  std::size_t most = 0;
  const std::size_t stride = std::max<std::size_t>(1, samples.size() / kMaxAsked);
  for (int h = 0; h < kHypotheses; ++h) {
    const std::size_t middle = sequence.below(samples.size());
    const auto other = [&] {
      const std::size_t step = sequence.below(samples.size() / 4 + kNear);
      return samples[std::min(samples.size() - 1, middle + step)].point;
    };
    const auto plane = plane_through({samples[middle].point, other(), other()});
    if (!plane) continue;
    const std::size_t agree = agreeing(samples, stride, *plane, noise, most);
    if (agree > most) {
      most = agree;
      best = plane;
    }
  }
  return most * stride >= kMinSamples ? best : std::nullopt;
}

}  // namespace

std::vector<BackgroundPlane> fit_planes(std::vector<SurfaceSample> samples,
                                        const geometry::DepthNoise& noise) {
  std::vector<BackgroundPlane> planes;
  Sequence sequence;
  for (int i = 0; i < kMaxPlanes && samples.size() >= kMinSamples; ++i) {
    const auto found = best_plane(samples, noise, sequence);
    if (!found) break;
    std::vector<SurfaceSample> on_plane;
    std::ranges::copy_if(samples, std::back_inserter(on_plane),
                         [&](const SurfaceSample& s) { return agrees(*found, s, noise); });
    if (on_plane.size() < kMinSamples) break;
    const auto plane = fit(on_plane);
    if (plane) planes.push_back(*plane);
    std::erase_if(samples, [&](const SurfaceSample& s) {
      return agrees(*found, s, noise) || (plane && agrees(*plane, s, noise));
    });
  }
  return planes;
}

}  // namespace rds::segmentation
