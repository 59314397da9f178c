// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/pose/feature_alignment.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace rds::tracker {
namespace {

constexpr int kHalf = 4;
constexpr int kSide = 2 * kHalf;
constexpr float kArea = kSide * kSide;
constexpr int kBordered = kSide + 2;
constexpr int kIterations = 10;
constexpr float kConverged = 0.02F;    // px
constexpr float kMinStructure = 50;    // grey levels²: determinant by trace of the gradients' 2×2 matrix
constexpr float kLargestGain = 3;      // of contrast between the two pictures
constexpr double kLargestScaling = 4;  // between the two pictures

template <int Size>
using Square = Eigen::Array<float, Size, Size, Eigen::RowMajor>;
using Patch = Square<kSide>;

int level_of(double scale, int levels) {
  return std::clamp(static_cast<int>(std::lround(std::log2(scale))), 0, levels - 1);
}

/// The reference's patch as a level of the picture should show it, with a border of one pixel.
bool warp_patch(const PatchWarp& warp, int level, Square<kBordered>& patch) {
  const int reference_level = level_of(warp.scale, warp.reference->levels());
  const Eigen::Matrix2f reference_from_picture =
      std::ldexp(1.0F, level - reference_level) * warp.picture_from_reference.inverse();
  const Eigen::Vector2f centre = ImagePyramid::at_level(warp.reference_px, reference_level);
  constexpr float kReach = kHalf + 1;
  const float reach = kReach * reference_from_picture.cwiseAbs().rowwise().sum().maxCoeff();
  if (!warp.reference->contains(centre, reach, reference_level)) return false;
  const cv::Mat& image = warp.reference->level(reference_level);
  for (int y = 0; y < kBordered; ++y) {
    Eigen::Vector2f place =
        centre + reference_from_picture * Eigen::Vector2f(-kReach, static_cast<float>(y) - kReach);
    for (int x = 0; x < kBordered; ++x, place += reference_from_picture.col(0))
      patch(y, x) = interpolate(image, place.x(), place.y());
  }
  return true;
}

/// What stays the same over the iterations: the reference patch and its gradients, all without their mean, so
/// that an offset of brightness falls out.
class Template {
 public:
  explicit Template(const Square<kBordered>& patch)
      : brightness_(patch.mean()),
        value_(centred(patch.block<kSide, kSide>(1, 1))),
        gx_(centred(0.5F * (patch.block<kSide, kSide>(1, 2) - patch.block<kSide, kSide>(1, 0)))),
        gy_(centred(0.5F * (patch.block<kSide, kSide>(2, 1) - patch.block<kSide, kSide>(0, 1)))),
        norm_(std::sqrt(value_.square().sum())) {
    const float xy = (gx_ * gy_).sum();
    hessian_ << gx_.square().sum(), xy, xy, gy_.square().sum();
    inverse_hessian_ = hessian_.inverse();
    value_by_gradient_ << (gx_ * value_).sum(), (gy_ * value_).sum();
  }

  [[nodiscard]] bool has_corner() const {
    return hessian_.determinant() >= kMinStructure * (hessian_.trace() + 1) && inverse_hessian_.allFinite();
  }

  struct Comparison {
    Eigen::Vector2f step;  // px, to where the picture looks more like the reference
    float correlation;
  };
  /// Contrast is taken to the reference's first. What the template is compared with needs no mean taken off:
  /// the template has none.
  [[nodiscard]] Comparison compare(const Patch& seen) const {
    const Patch shifted = seen - brightness_;  // near 0, so that squares keep their digits
    const float sum = shifted.sum();
    const float norm = std::sqrt(std::max(0.0F, shifted.square().sum() - sum * sum / kArea)) + 1e-3F;
    const float gain = std::clamp(norm_ / norm, 1 / kLargestGain, kLargestGain);
    const Eigen::Vector2f by_gradient((gx_ * shifted).sum(), (gy_ * shifted).sum());
    return {inverse_hessian_ * (value_by_gradient_ - gain * by_gradient),
            (shifted * value_).sum() / (norm * norm_ + 1e-3F)};
  }

 private:
  static Patch centred(const Patch& values) { return values - values.mean(); }

  float brightness_;
  Patch value_;
  Patch gx_;
  Patch gy_;
  float norm_;
  Eigen::Matrix2f hessian_;
  Eigen::Matrix2f inverse_hessian_;
  Eigen::Vector2f value_by_gradient_;
};

}  // namespace

std::optional<AlignedPatch> align_feature(const PatchWarp& warp, const ImagePyramid& picture,
                                          const Eigen::Vector2f& expected_px, double max_shift) {
  const double scaling = std::sqrt(std::abs(static_cast<double>(warp.picture_from_reference.determinant())));
  if (!(scaling < kLargestScaling && scaling * kLargestScaling > 1)) return std::nullopt;
  const int level = level_of(warp.scale * scaling, picture.levels());
  Square<kBordered> bordered;
  if (!warp_patch(warp, level, bordered)) return std::nullopt;
  const Template reference(bordered);
  if (!reference.has_corner()) return std::nullopt;
  const Eigen::Vector2f expected = ImagePyramid::at_level(expected_px, level);
  Eigen::Vector2f place = expected;
  for (int i = 0; i < kIterations; ++i) {
    if (!picture.contains(place, kHalf, level)) return std::nullopt;
    const Template::Comparison comparison = reference.compare(
        interpolate_square<kSide>(picture.level(level), place.x() - kHalf, place.y() - kHalf));
    place += comparison.step;
    if (!((place - expected).norm() <= static_cast<float>(max_shift))) return std::nullopt;
    if (comparison.step.norm() < kConverged)
      return AlignedPatch{ImagePyramid::at_picture(place, level), comparison.correlation};
  }
  return std::nullopt;
}

}  // namespace rds::tracker
