// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/pose/sparse_image_alignment.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>

#include "services/tracker/core/motion/se3.hpp"
#include "services/tracker/core/pose/observation_model.hpp"

namespace rds::tracker {
namespace {

using Vector6f = Eigen::Matrix<float, 6, 1>;
using Matrix6f = Eigen::Matrix<float, 6, 6>;

constexpr int kHalf = 2;  // of a patch's side, px
constexpr int kSide = 2 * kHalf;
constexpr float kArea = kSide * kSide;
constexpr std::size_t kMinPatches = 20;
constexpr float kFreedom = 5;             // ν of Student's t: Kerl et al. 2013
constexpr float kFinestScale = 1;         // grey levels
constexpr int kScaleIterations = 8;       // at most
constexpr float kScaleConverged = 0.01F;  // share of its square
constexpr double kConverged = 2e-5;       // m and rad
constexpr int kFinestLevel = 2;           // the last; from there on points are found one by one
constexpr int kIterations = 10;           // per level, at most

using Square = Eigen::Array<float, kSide, kSide, Eigen::RowMajor>;

/// What a patch of the reference picture says at one level.
struct ReferencePatch {
  Eigen::Vector3d point;
  Eigen::Vector2d seen_from_projected;  // px of the picture
  Square value;
  Square gx, gy;                               // derivatives of the value
  Eigen::Matrix<float, 2, 6> place_by_motion;  // of its place, px of the level
};

bool cut(const ImagePyramid& reference, const SeenPoint& seen, int level, const geometry::CameraModel& camera,
         ReferencePatch& patch) {
  const Eigen::Vector2f place = ImagePyramid::at_level(seen.image_px, level);
  if (!reference.contains(place, kHalf + 1, level)) return false;
  const Eigen::Vector3d& p = seen.in_reference;
  Eigen::Matrix<double, 3, 6> point_by_motion;
  point_by_motion << Eigen::Matrix3d::Identity(), -skew(p);
  patch.point = p;
  patch.seen_from_projected = seen.image_px.cast<double>() - camera.project(p);
  patch.place_by_motion =
      (std::ldexp(1.0, -level) * camera.undistorted_by_point(p) * point_by_motion).cast<float>();
  const auto bordered =
      interpolate_square<kSide + 2>(reference.level(level), place.x() - kHalf - 1, place.y() - kHalf - 1);
  patch.value = bordered.block<kSide, kSide>(1, 1);
  patch.gx = 0.5F * (bordered.block<kSide, kSide>(1, 2) - bordered.block<kSide, kSide>(1, 0));
  patch.gy = 0.5F * (bordered.block<kSide, kSide>(2, 1) - bordered.block<kSide, kSide>(0, 1));
  return true;
}

/// A reference patch and what the picture differs from it by.
struct Comparison {
  const ReferencePatch* patch;
  Square difference;
};

float at_least_finest(float scale2) {
  return std::max(scale2, kFinestScale * kFinestScale);
}

/// The scale of Student's t that the residuals are most likely of (Kerl et al. 2013, §III).
/// @param scale2  where to start; 0: at their mean square. @return its square.
float squared_scale(std::span<const Comparison> comparisons, float offset, float scale2) {
  const float pixels = static_cast<float>(comparisons.size()) * kArea;
  if (scale2 == 0) {
    for (const Comparison& c : comparisons) scale2 += (c.difference - offset).square().sum();
    scale2 = at_least_finest(scale2 / pixels);
  }
  for (int i = 0; i < kScaleIterations; ++i) {
    float sum = 0;
    for (const Comparison& c : comparisons) {
      const Square squared = (c.difference - offset).square();
      sum += (squared / (kFreedom + squared / scale2)).sum();
    }
    const float before = scale2;
    scale2 = at_least_finest((kFreedom + 1) * sum / pixels);
    if (std::abs(before - scale2) < kScaleConverged * before) break;
  }
  return scale2;
}

/// −log of the residuals' likelihood, per pixel, but for a constant.
float cost_of(std::span<const Comparison> comparisons, float offset, float scale2) {
  float sum = 0;
  for (const Comparison& c : comparisons) {
    const Square factor = 1 + (c.difference - offset).square() / (kFreedom * scale2);
    // Of the product of eight a float has room for: 1 + 510² / 5 each, at most.
    sum += std::log(factor.topRows<2>().prod()) + std::log(factor.bottomRows<2>().prod());
  }
  const float pixels = static_cast<float>(comparisons.size()) * kArea;
  return 0.5F * (std::log(scale2) + (kFreedom + 1) * sum / pixels);
}

/// Normal equations of all patches at one pose.
struct Equations {
  Matrix6f hessian = Matrix6f::Zero();
  Vector6f gradient = Vector6f::Zero();
  float differences = 0;  // weighted
  float weights = 0;

  [[nodiscard]] float mean_difference() const { return differences / weights; }
};

/// A pixel's derivative is its gradient times the patch's place_by_motion, so that the pixels can be summed
/// up in two dimensions before six.
void add(const Comparison& comparison, float offset, float scale2, Equations& sum) {
  const ReferencePatch& patch = *comparison.patch;
  const Square residual = comparison.difference - offset;
  const Square weight = (kFreedom + 1) / (kFreedom + residual.square() / scale2);
  const Square weighted_gx = weight * patch.gx;
  const Square weighted_gy = weight * patch.gy;
  const float xy = (weighted_gx * patch.gy).sum();
  Eigen::Matrix2f hessian;
  hessian << (weighted_gx * patch.gx).sum(), xy, xy, (weighted_gy * patch.gy).sum();
  const Eigen::Vector2f gradient((weighted_gx * residual).sum(), (weighted_gy * residual).sum());
  sum.hessian.noalias() += patch.place_by_motion.transpose() * (hessian * patch.place_by_motion).eval();
  sum.gradient.noalias() += patch.place_by_motion.transpose() * gradient;
  sum.differences += (weight * comparison.difference).sum();
  sum.weights += weight.sum();
}

/// How a pose explains the picture.
struct Explanation {
  geometry::Pose pose;
  std::vector<Comparison> comparisons;  // of the patches that the picture shows
  float scale2 = 0;
  float cost = std::numeric_limits<float>::max();
};

class LevelAlignment {
 public:
  LevelAlignment(std::span<const ReferencePatch> patches, const ImagePyramid& picture, int level,
                 const geometry::CameraModel& camera)
      : patches_(patches), picture_(picture), level_(level), camera_(camera) {}

  /// @param scale2  where the search for the squared scale begins; 0 if nothing is known.
  [[nodiscard]] Explanation explain(const geometry::Pose& pose, float offset, float scale2 = 0) const {
    Explanation by{pose, compare(pose)};
    if (by.comparisons.size() < kMinPatches) return by;
    by.scale2 = squared_scale(by.comparisons, offset, scale2);
    by.cost = cost_of(by.comparisons, offset, by.scale2);
    return by;
  }

  /// Improves pose and brightness offset while that lowers the cost.
  [[nodiscard]] geometry::Pose improve(Explanation best, float& offset) const {
    for (int i = 0; i < kIterations && best.comparisons.size() >= kMinPatches; ++i) {
      Equations sum;
      for (const Comparison& comparison : best.comparisons) add(comparison, offset, best.scale2, sum);
      offset = sum.mean_difference();
      const Twist step = sum.hessian.cast<double>().ldlt().solve(sum.gradient.cast<double>());
      if (!step.allFinite()) break;
      const geometry::Pose next = best.pose * se3_exp(-step);
      if (step.norm() < kConverged) return next;
      Explanation by_next = explain(next, offset, best.scale2);
      if (by_next.cost > best.cost) break;
      best = std::move(by_next);
    }
    return best.pose;
  }

 private:
  [[nodiscard]] std::vector<Comparison> compare(const geometry::Pose& pose) const {
    std::vector<Comparison> comparisons;
    comparisons.reserve(patches_.size());
    for (const ReferencePatch& patch : patches_) {
      const Eigen::Vector3d p = pose * patch.point;
      if (p.z() < kMinDepth) continue;
      const Eigen::Vector2d px = camera_.project(p) + patch.seen_from_projected;
      const Eigen::Vector2f place = ImagePyramid::at_level(px.cast<float>(), level_);
      if (!picture_.contains(place, kHalf, level_)) continue;
      const auto shown =
          interpolate_square<kSide>(picture_.level(level_), place.x() - kHalf, place.y() - kHalf);
      comparisons.push_back({&patch, shown - patch.value});
    }
    return comparisons;
  }

  std::span<const ReferencePatch> patches_;
  const ImagePyramid& picture_;
  int level_;
  const geometry::CameraModel& camera_;
};

}  // namespace

geometry::Pose align_sparsely(const ImagePyramid& reference, std::span<const SeenPoint> points,
                              const ImagePyramid& picture, const geometry::CameraModel& camera,
                              const geometry::Pose& start) {
  geometry::Pose pose = start;
  float offset = 0;
  std::vector<ReferencePatch> patches;
  patches.reserve(points.size());
  const int coarsest = std::min({kAlignmentLevels - 1, reference.levels() - 1, picture.levels() - 1});
  for (int level = coarsest; level >= kFinestLevel; --level) {
    patches.clear();
    for (const SeenPoint& seen : points)
      if (ReferencePatch patch; cut(reference, seen, level, camera, patch)) patches.push_back(patch);
    const LevelAlignment alignment(patches, picture, level, camera);
    Explanation best = alignment.explain(pose, offset);
    if (level < coarsest) {
      // A coarse level, which shows few of a pattern's details, may have led astray.
      Explanation by_start = alignment.explain(start, offset);
      if (by_start.cost < best.cost) best = std::move(by_start);
    }
    pose = alignment.improve(std::move(best), offset);
  }
  return pose;
}

}  // namespace rds::tracker
