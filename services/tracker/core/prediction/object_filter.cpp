// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/prediction/object_filter.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace rds::tracker::prediction {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Matrix63 = Eigen::Matrix<double, 6, 3>;

// Process noise: people start, stop and turn, along the ground.
constexpr double kAcceleration = 1.5;   // m/s²/√Hz
constexpr double kInitialSpeed = 1.2;   // m/s, standard deviation before motion has been seen
constexpr double kVerticalShare = 0.3;  // of both, along the picture's y axis
constexpr double kSizeDrift = 0.5;      // m/√s, how fast sizes wander (people turn, arms move)
// Measurement noise: standard deviations of a detected centre across the viewing direction, along the
// picture's y axis and along the viewing direction, and of a detected width or height.
constexpr double kLateralNoiseM = 0.08;
constexpr double kVerticalNoiseM = 0.15;
constexpr double kDepthNoiseM = 0.15;
constexpr double kSizeNoiseM = 0.06;
constexpr double kUnknownSigmaM = 100;

double square(double x) {
  return x * x;
}

/// Along one axis of the detection's box: what a detection says about a predicted extent.
struct Extent {
  double motion = 0;         // of the object, beyond the predicted one [m]
  double center_offset = 0;  // from the predicted centre to the new one [m]
  double size = 0;           // [m]
  bool motion_known = true;
};

double smaller_of_same_sign(double a, double b) {
  if (a * b <= 0) return 0;
  return std::abs(a) < std::abs(b) ? a : b;
}

/// @param low, high  the detection's ends, relative to the predicted centre. @param size  predicted.
///
/// An end that the picture cuts off says nothing about motion, and the object is not smaller for it. An end
/// that moves alone is a change of what is visible, not motion: both ends must have moved.
Extent compare_extent(double low, double high, double size, bool low_cut, bool high_cut, double least_size) {
  const double low_shift = low + size / 2;
  const double high_shift = high - size / 2;
  Extent extent;
  extent.motion_known = !(low_cut && high_cut);
  if (!low_cut && !high_cut)
    extent.motion = smaller_of_same_sign(low_shift, high_shift);
  else if (extent.motion_known)
    extent.motion = low_cut ? high_shift : low_shift;
  if (low_cut) low = std::min({low, extent.motion - size / 2, high_cut ? low : high - least_size});
  if (high_cut) high = std::max({high, extent.motion + size / 2, low_cut ? high : low + least_size});
  extent.center_offset = (low + high) / 2;
  extent.size = high - low;
  return extent;
}

Eigen::Matrix3d in_map(const Eigen::Vector3d& sigma_in_box, const Eigen::Matrix3d& map_from_box) {
  return map_from_box * sigma_in_box.array().square().matrix().asDiagonal() * map_from_box.transpose();
}

/// Objects move along the ground: across and along the viewing direction of a camera that is held upright.
const Eigen::Vector3d kUpright(1, kVerticalShare, 1);

}  // namespace

struct ObjectFilter::Innovation {
  Eigen::Vector3d motion;  // of the centre [m], map frame
  Eigen::Vector3d jump;    // of the centre because other parts have become visible [m], map frame
  Eigen::Vector3d size;
  Eigen::Matrix3d noise;
};

ObjectFilter::ObjectFilter(const geometry::OrientedBox& box, const CutSides& cut)
    : size_(box.size),
      size_variance_(Eigen::Vector3d::Constant(square(kSizeNoiseM))),
      map_from_box_(box.map_from_box.linear()) {
  state_.head<3>() = box.center();
  const Innovation first = compare(box, cut);
  state_.head<3>() += first.jump;
  size_ = first.size;
  covariance_.topLeftCorner<3, 3>() = in_map({kLateralNoiseM, kVerticalNoiseM, kDepthNoiseM}, map_from_box_);
  covariance_.bottomRightCorner<3, 3>() = in_map(kInitialSpeed * kUpright, map_from_box_);
}

void ObjectFilter::predict(double seconds) {
  Matrix6 transition = Matrix6::Identity();
  transition.topRightCorner<3, 3>().diagonal().setConstant(seconds);
  state_ = transition * state_;
  covariance_ = transition * covariance_ * transition.transpose();
  const Eigen::Matrix3d q = in_map(kAcceleration * kUpright, map_from_box_);
  covariance_.topLeftCorner<3, 3>() += q * (seconds * seconds * seconds / 3);  // ∫ F G q Gᵀ Fᵀ dt
  covariance_.topRightCorner<3, 3>() += q * (seconds * seconds / 2);
  covariance_.bottomLeftCorner<3, 3>() += q * (seconds * seconds / 2);
  covariance_.bottomRightCorner<3, 3>() += q * seconds;
  size_variance_.array() += square(kSizeDrift) * seconds;
}

ObjectFilter::Innovation ObjectFilter::compare(const geometry::OrientedBox& box, const CutSides& cut) const {
  const Eigen::Matrix3d map_from_box = box.map_from_box.linear();
  const Eigen::Vector3d offset = map_from_box.transpose() * (box.center() - center());
  const Eigen::Vector3d half = box.size / 2;
  const Extent across = compare_extent(offset.x() - half.x(), offset.x() + half.x(), size_.x(), cut.left,
                                       cut.right, kMinWidthM);
  const Extent down =
      compare_extent(offset.y() - half.y(), offset.y() + half.y(), size_.y(), cut.top, cut.bottom, 0);
  const Eigen::Vector3d motion(across.motion, down.motion, offset.z());
  const Eigen::Vector3d whole(across.center_offset, down.center_offset, offset.z());
  const Eigen::Vector3d sigma(across.motion_known ? kLateralNoiseM : kUnknownSigmaM,
                              down.motion_known ? kVerticalNoiseM : kUnknownSigmaM, kDepthNoiseM);
  return {map_from_box * motion,
          map_from_box * (whole - motion),
          {across.size, down.size, box.size.z()},
          in_map(sigma, map_from_box)};
}

void ObjectFilter::correct(const geometry::OrientedBox& box, const CutSides& cut) {
  const Innovation innovation = compare(box, cut);
  map_from_box_ = box.map_from_box.linear();
  const Eigen::Matrix3d covariance = center_covariance() + innovation.noise;
  const Matrix63 gain = covariance_.leftCols<3>() * covariance.inverse();
  state_ += gain * innovation.motion;
  Matrix6 keep = Matrix6::Identity();
  keep.leftCols<3>() -= gain;
  covariance_ =
      keep * covariance_ * keep.transpose() + gain * innovation.noise * gain.transpose();  // Joseph's form
  state_.head<3>() += innovation.jump;
  const Eigen::Array3d size_gain = size_variance_.array() / (size_variance_.array() + square(kSizeNoiseM));
  size_.array() += size_gain * (innovation.size - size_).array();
  size_variance_.array() *= 1 - size_gain;
}

double ObjectFilter::mahalanobis(const geometry::OrientedBox& box, const CutSides& cut) const {
  const Innovation innovation = compare(box, cut);
  const Eigen::Matrix3d covariance = center_covariance() + innovation.noise;
  return std::sqrt(std::max(0.0, innovation.motion.dot(covariance.inverse() * innovation.motion)));
}

void ObjectFilter::move_map(const geometry::Pose& new_from_old) {
  Matrix6 rotation = Matrix6::Zero();
  rotation.topLeftCorner<3, 3>() = rotation.bottomRightCorner<3, 3>() = new_from_old.linear();
  state_ = rotation * state_;
  state_.head<3>() += new_from_old.translation();
  covariance_ = rotation * covariance_ * rotation.transpose();
  map_from_box_ = new_from_old.linear() * map_from_box_;
}

geometry::OrientedBox ObjectFilter::box() const {
  geometry::OrientedBox box;
  box.map_from_box.linear() = map_from_box_;
  box.map_from_box.translation() = center();
  box.size = size_;
  return box;
}

Eigen::Vector3d ObjectFilter::center_sigma_in_box() const {
  return (map_from_box_.transpose() * center_covariance() * map_from_box_).diagonal().cwiseMax(0).cwiseSqrt();
}

}  // namespace rds::tracker::prediction
