// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/pose/sparse_image_alignment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
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
constexpr int kArea = kSide * kSide;
constexpr int kMinPatches = 20;
constexpr float kHuber = 12;         // grey levels
constexpr double kConverged = 2e-5;  // m and rad
constexpr int kFinestLevel = 2;      // the last; from there on points are found one by one
constexpr int kIterations = 10;      // per level, at most

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

/// Normal equations of all patches at one pose.
struct Equations {
  Matrix6f hessian = Matrix6f::Zero();
  Vector6f gradient = Vector6f::Zero();
  float cost = 0;
  float differences = 0;  // weighted
  float weights = 0;
  int pixels = 0;

  [[nodiscard]] float mean_cost() const { return cost / static_cast<float>(pixels); }
  [[nodiscard]] float mean_difference() const { return differences / weights; }
};

/// A pixel's derivative is its gradient times the patch's place_by_motion, so that the pixels can be summed
/// up in two dimensions before six.
void add(const ReferencePatch& patch, const Eigen::Vector2f& place, const cv::Mat& image, float offset,
         Equations& sum) {
  const Square difference =
      interpolate_square<kSide>(image, place.x() - kHalf, place.y() - kHalf) - patch.value;
  const Square residual = difference - offset;
  const Square size = residual.abs();
  const Square weight = kHuber / size.max(kHuber);
  const Square quadratic = size.min(kHuber);
  const Square weighted_gx = weight * patch.gx;
  const Square weighted_gy = weight * patch.gy;
  const float xy = (weighted_gx * patch.gy).sum();
  Eigen::Matrix2f hessian;
  hessian << (weighted_gx * patch.gx).sum(), xy, xy, (weighted_gy * patch.gy).sum();
  const Eigen::Vector2f gradient((weighted_gx * residual).sum(), (weighted_gy * residual).sum());
  sum.hessian.noalias() += patch.place_by_motion.transpose() * (hessian * patch.place_by_motion).eval();
  sum.gradient.noalias() += patch.place_by_motion.transpose() * gradient;
  sum.cost += (quadratic * (2 * size - quadratic)).sum();
  sum.differences += (weight * difference).sum();
  sum.weights += weight.sum();
  sum.pixels += kArea;
}

class LevelAlignment {
 public:
  LevelAlignment(std::span<const ReferencePatch> patches, const ImagePyramid& picture, int level,
                 const geometry::CameraModel& camera)
      : patches_(patches), picture_(picture), level_(level), camera_(camera) {}

  /// Improves pose and brightness offset while that lowers the cost.
  void run(geometry::Pose& pose, float& offset) const {
    geometry::Pose best = pose;
    float least = std::numeric_limits<float>::max();
    for (int i = 0; i < kIterations; ++i) {
      const Equations sum = linearize(pose, offset);
      if (sum.pixels < kMinPatches * kArea || sum.mean_cost() > least) break;
      least = sum.mean_cost();
      best = pose;
      offset = sum.mean_difference();
      const Twist step = sum.hessian.cast<double>().ldlt().solve(sum.gradient.cast<double>());
      if (!step.allFinite()) break;
      pose = pose * se3_exp(-step);
      if (step.norm() < kConverged) return;
    }
    pose = best;
  }

 private:
  [[nodiscard]] Equations linearize(const geometry::Pose& pose, float offset) const {
    Equations sum;
    for (const ReferencePatch& patch : patches_) {
      const Eigen::Vector3d p = pose * patch.point;
      if (p.z() < kMinDepth) continue;
      const Eigen::Vector2d px = camera_.project(p) + patch.seen_from_projected;
      const Eigen::Vector2f place = ImagePyramid::at_level(px.cast<float>(), level_);
      if (picture_.contains(place, kHalf, level_)) add(patch, place, picture_.level(level_), offset, sum);
    }
    return sum;
  }

  std::span<const ReferencePatch> patches_;
  const ImagePyramid& picture_;
  int level_;
  const geometry::CameraModel& camera_;
};

}  // namespace

geometry::Pose align_sparsely(const ImagePyramid& reference, std::span<const SeenPoint> points,
                              const ImagePyramid& picture, const geometry::CameraModel& camera,
                              const geometry::Pose& camera_from_reference) {
  geometry::Pose pose = camera_from_reference;
  float offset = 0;
  std::vector<ReferencePatch> patches;
  patches.reserve(points.size());
  const int coarsest = std::min({kAlignmentLevels - 1, reference.levels() - 1, picture.levels() - 1});
  for (int level = coarsest; level >= kFinestLevel; --level) {
    patches.clear();
    for (const SeenPoint& seen : points)
      if (ReferencePatch patch; cut(reference, seen, level, camera, patch)) patches.push_back(patch);
    LevelAlignment(patches, picture, level, camera).run(pose, offset);
  }
  return pose;
}

}  // namespace rds::tracker
