// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/calibration/self_calibration.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace rds::tracker {
namespace {

constexpr Eigen::Index kImaging = 2;
constexpr Eigen::Index kPose = 6;
constexpr double kFreePose = 1e-2;             // information [1/m², 1/rad²] about every pose: next to none
constexpr double kReadoutSigmaS = 0.02;        // standard deviation of the given readout time …
constexpr double kFocalSigma = 0.05;           // … and of the given focal length, as a share of it
constexpr double kToleratedReadoutS = 0.001;   // errors of the given ones that are left as they are, …
constexpr double kToleratedFocalError = 0.01;  // … as a share
constexpr double kMemory = 0.9;     // share of the information that is left when the next keyframe's is added
constexpr double kSignificant = 3;  // σ by which what was given must be off
constexpr double kLargestFocalSigma = 0.015;  // of a bundle that is believed
constexpr double kLargestFocalShare = 1.15;   // it may find, either way; more comes from things that move
constexpr int kFewestBundles = 5;             // that were believed, before a focal length is called wrong
constexpr double kLargestFocalError = 1.4;    // factor, either way
constexpr double kLongestReadout = 0.05;      // s, either way: a camera may hang upside down

/// Where a camera's pose starts among the unknowns; camera 0 is no unknown.
Eigen::Index pose_at(std::size_t camera) {
  return kImaging + kPose * (static_cast<Eigen::Index>(camera) - 1);
}

Eigen::Index unknowns(std::size_t cameras) {
  return cameras == 0 ? kImaging : pose_at(cameras);
}

struct Part {
  Eigen::Index at;
  Eigen::Index size;
  Eigen::Matrix<double, 3, 6> by_point;  // Jpᵀ J
};

bool is_believable_focal(const ImagingEstimate& found) {
  const double variance = found.information.inverse()(1, 1);
  return variance > 0 && variance < kLargestFocalSigma * kLargestFocalSigma &&
         found.value(1) < kLargestFocalShare && found.value(1) > 1 / kLargestFocalShare;
}

/// The same estimate without what it says of the focal length.
ImagingEstimate of_readout_only(ImagingEstimate found) {
  Eigen::Matrix2d& information = found.information;
  if (information(1, 1) > 0) information(0, 0) -= information(0, 1) * information(1, 0) / information(1, 1);
  information(0, 1) = information(1, 0) = information(1, 1) = 0;
  return found;
}

}  // namespace

ImagingEstimator::ImagingEstimator(std::size_t cameras)
    : normal_(Eigen::MatrixXd::Zero(unknowns(cameras), unknowns(cameras))),
      gradient_(Eigen::VectorXd::Zero(unknowns(cameras))) {
  normal_.diagonal().tail(normal_.rows() - kImaging).setConstant(kFreePose);
}

void ImagingEstimator::add_point(std::span<const ObservationDerivatives> observations) {
  Eigen::Matrix3d point = Eigen::Matrix3d::Zero();
  Eigen::Vector3d point_gradient = Eigen::Vector3d::Zero();
  std::vector<Part> parts{{0, kImaging, Eigen::Matrix<double, 3, 6>::Zero()}};
  for (const ObservationDerivatives& o : observations) {
    point += o.by_point.transpose() * o.by_point;
    point_gradient += o.by_point.transpose() * o.residual;
    parts.front().by_point.leftCols<kImaging>() += o.by_point.transpose() * o.by_imaging;
    normal_.topLeftCorner<kImaging, kImaging>() += o.by_imaging.transpose() * o.by_imaging;
    gradient_.head<kImaging>() += o.by_imaging.transpose() * o.residual;
    if (o.camera == 0) continue;
    const Eigen::Index at = pose_at(o.camera);
    normal_.block<kPose, kPose>(at, at) += o.by_pose.transpose() * o.by_pose;
    normal_.block<kPose, kImaging>(at, 0) += o.by_pose.transpose() * o.by_imaging;
    gradient_.segment<kPose>(at) += o.by_pose.transpose() * o.residual;
    parts.push_back({at, kPose, o.by_point.transpose() * o.by_pose});
  }
  if (point.determinant() <= 0) return;
  const Eigen::Matrix3d inverse = point.inverse();
  for (const Part& a : parts) {
    const Eigen::Matrix<double, 6, 3> weighted = a.by_point.transpose() * inverse;
    gradient_.segment(a.at, a.size) -= weighted.topRows(a.size) * point_gradient;
    for (const Part& b : parts)
      if (b.at <= a.at)
        normal_.block(a.at, b.at, a.size, b.size) -= weighted.topRows(a.size) * b.by_point.leftCols(b.size);
  }
}

ImagingEstimate ImagingEstimator::estimate(const Imaging& at) const {
  const Eigen::Index poses = normal_.rows() - kImaging;
  Eigen::Matrix2d information = normal_.topLeftCorner<kImaging, kImaging>();
  Eigen::Vector2d gradient = gradient_.head<kImaging>();
  if (poses > 0) {
    const Eigen::MatrixXd by_poses = normal_.bottomLeftCorner(poses, kImaging);
    const Eigen::LDLT<Eigen::MatrixXd> solver(normal_.bottomRightCorner(poses, poses));
    information -= by_poses.transpose() * solver.solve(by_poses);
    gradient -= by_poses.transpose() * solver.solve(gradient_.tail(poses));
  }
  const Eigen::LLT<Eigen::Matrix2d> solver(information);
  if (!information.allFinite() || solver.info() != Eigen::Success) return {at, Eigen::Matrix2d::Zero()};
  return {at - solver.solve(gradient), information};
}

SelfCalibration::SelfCalibration(const SelfCalibrationConfig& config) : config_(config) {
  belief_.value = Imaging(config.readout_s, 1);
  belief_.information =
      Eigen::Vector2d(kReadoutSigmaS, kFocalSigma).array().square().inverse().matrix().asDiagonal();
}

geometry::CameraModel SelfCalibration::calibrated(const geometry::CameraModel& given) {
  if (given.fx != given_fx_) belief_ = SelfCalibration(config_).belief_;
  given_fx_ = given.fx;
  geometry::CameraModel camera = given;
  camera.fx *= focal_scale();
  camera.fy *= focal_scale();
  return camera;
}

void SelfCalibration::begin_with(const KnownCamera& camera) {
  given_fx_ = camera.given_fx;
  const double scale = camera.focal_scale;
  const bool possible = scale >= 1 / kLargestFocalError && scale <= kLargestFocalError;
  if (!config_.focal_length || !possible) return;
  belief_.value(1) = scale;
  belief_.focal_is_wrong = std::abs(scale - 1) > kToleratedFocalError;
}

void SelfCalibration::begin_with(double given_fx, const ImagingBelief& belief) {
  given_fx_ = given_fx;
  belief_ = belief;
}

void SelfCalibration::update(std::uint64_t keyframe, const ImagingEstimate& estimate) {
  if (newest_keyframe_ && keyframe <= *newest_keyframe_) return;
  newest_keyframe_ = keyframe;
  update(estimate);
}

void SelfCalibration::update(const ImagingEstimate& estimate) {
  if (!estimate.value.allFinite() || !estimate.information.allFinite()) return;
  const bool believed = is_believable_focal(estimate);
  const ImagingEstimate found = believed ? estimate : of_readout_only(estimate);
  auto& [value, information, readout_is_wrong, focal_is_wrong, focal_bundles] = belief_;
  focal_bundles += believed ? 1 : 0;
  const Eigen::Matrix2d old = kMemory * information;
  information = old + found.information;
  value = information.llt().solve(old * value + found.information * found.value);
  value(0) = std::clamp(value(0), -kLongestReadout, kLongestReadout);
  value(1) = std::clamp(value(1), 1 / kLargestFocalError, kLargestFocalError);
  const Imaging error = (value - Imaging(config_.readout_s, 1)).cwiseAbs();
  const Imaging margin = kSignificant * information.inverse().diagonal().cwiseSqrt();
  readout_is_wrong |= config_.readout && error(0) > kToleratedReadoutS + margin(0);
  focal_is_wrong |=
      config_.focal_length && focal_bundles >= kFewestBundles && error(1) > kToleratedFocalError + margin(1);
}

}  // namespace rds::tracker
