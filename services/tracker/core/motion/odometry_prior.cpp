// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/motion/odometry_prior.hpp"

#include <cmath>
#include <numeric>

#include <Eigen/Cholesky>

namespace rds::tracker {
namespace {

constexpr double kNsPerSecond = 1e9;
constexpr double kWindowS = 0.5;
constexpr std::size_t kWindows = 5;   // that trust is made of
constexpr double kChi2 = 22.46;       // of one window, six degrees of freedom, 0.999
constexpr double kChi2OfAll = 59.70;  // of all of them
constexpr double kMovedM = 0.03;      // by odometry or by vision: a window that says something, …
constexpr double kMovedRad = 0.03;    // … as vision is wrong by less

constexpr double kInitialScaleSigma = 0.1;
constexpr double kKnownScaleSigma = 0.04;       // of the way
constexpr double kScaleSigmaPerSecond = 0.001;  // grows with the root: load, tyres, floors

constexpr double kVisionM = 0.007;  // standard deviations of a pose that vision is sure of, …
constexpr double kVisionRad = 0.005;
constexpr double kMaxSigmaM = 0.25;  // beyond, the way is a guess: a robot's breadth
constexpr double kMaxSigmaRad = 0.25;

Matrix6 vision_covariance() {
  Twist variance;
  variance << Eigen::Vector3d::Constant(kVisionM * kVisionM),
      Eigen::Vector3d::Constant(kVisionRad * kVisionRad);
  return variance.asDiagonal();
}

Matrix6 moved(const Matrix6& covariance, const geometry::Pose& to_from_here) {
  const Matrix6 by = adjoint(to_from_here);
  return by * covariance * by.transpose();
}

double largest_sigma(const Eigen::Matrix3d& covariance) {
  return std::sqrt(covariance.diagonal().maxCoeff());
}

}  // namespace

Eigen::Matrix2d OdometryPrior::initial_scale_covariance() {
  return Eigen::Matrix2d::Identity() * (kInitialScaleSigma * kInitialScaleSigma);
}

void OdometryPrior::go_to(std::int64_t stamp_ns) {
  if (!odometry_) return;
  const auto before = std::exchange(now_, odometry_(stamp_ns));
  const std::int64_t before_ns = std::exchange(now_ns_, stamp_ns);
  if (!before || !now_ || before->segment != now_->segment || stamp_ns <= before_ns) {
    window_.reset();
    return;
  }
  const Twist step = se3_log(before->odom_from_body.inverse() * now_->odom_from_body);
  const double step_s = static_cast<double>(stamp_ns - before_ns) / kNsPerSecond;
  scale_covariance_.diagonal().array() += kScaleSigmaPerSecond * kScaleSigmaPerSecond * step_s;
  if (window_) window_->path.extend(step, scale_, step_s);
}

void OdometryPrior::begin_window() {
  window_.reset();
  if (now_) window_ = Window{now_->body_from_camera, {}};
}

std::optional<OdometryPrior::Motion> OdometryPrior::since_begin() const {
  if (!window_ || !is_trusted()) return std::nullopt;
  const OdometryPath& path = window_->path;
  const geometry::Pose camera_from_body = now_->body_from_camera.inverse();
  Motion motion;
  motion.begin_from_camera =
      window_->body_from_camera.inverse() * path.begin_from_end() * now_->body_from_camera;
  motion.covariance = moved(path.covariance(scale_covariance_), camera_from_body) +
                      moved(vision_covariance(), motion.begin_from_camera.inverse());
  if (largest_sigma(motion.covariance.topLeftCorner<3, 3>()) > kMaxSigmaM ||
      largest_sigma(motion.covariance.bottomRightCorner<3, 3>()) > kMaxSigmaRad)
    return std::nullopt;
  return motion;
}

bool OdometryPrior::observe(const geometry::Pose& begin_from_camera) {
  if (!now_) return false;
  if (window_ && window_->path.duration_s() < kWindowS) return false;
  if (window_) learn(begin_from_camera);
  begin_window();
  return true;
}

/// The window's innovation r = log(B̂⁻¹ B), of the body's motion by odometry and by vision, has the covariance
/// S = G P Gᵀ + Q + R, with the scale's P, the path's noise Q, vision's R.
void OdometryPrior::learn(const geometry::Pose& begin_from_camera) {
  const OdometryPath& path = window_->path;
  const geometry::Pose by_vision =
      window_->body_from_camera * begin_from_camera * now_->body_from_camera.inverse();
  const Twist innovation = se3_log(path.begin_from_end().inverse() * by_vision);
  const Matrix6 vision = vision_covariance() + moved(vision_covariance(), begin_from_camera.inverse());
  const Matrix6 covariance = path.covariance(scale_covariance_) + moved(vision, now_->body_from_camera);
  const auto solver = covariance.ldlt();
  const double squared = innovation.dot(solver.solve(innovation));
  const bool has_passed = squared <= kChi2;
  const bool has_moved = path.length_m() > kMovedM || path.turned_rad() > kMovedRad ||
                         begin_from_camera.translation().norm() > kMovedM ||
                         geometry::rotation_angle_rad(begin_from_camera.linear()) > kMovedRad;
  if (has_moved || !has_passed) innovations_.push_back(squared);
  if (innovations_.size() > kWindows) innovations_.pop_front();
  if (innovations_.size() == kWindows && !are_consistent()) return forget_scale();
  if (!has_passed) return;
  const Eigen::Matrix<double, 2, 6> gain = solver.solve(path.by_scale() * scale_covariance_).transpose();
  scale_ += gain * innovation;
  scale_covariance_ -= gain * path.by_scale() * scale_covariance_;
  scale_covariance_ = (scale_covariance_ + scale_covariance_.transpose()).eval() / 2;
}

/// What does not fit has another scale by now, or none: it is learned anew.
void OdometryPrior::forget_scale() {
  scale_ = OdometryScale::Ones();
  scale_covariance_ = initial_scale_covariance();
  innovations_.clear();
}

bool OdometryPrior::are_consistent() const {
  return std::accumulate(innovations_.begin(), innovations_.end(), 0.0) <= kChi2OfAll;
}

bool OdometryPrior::is_trusted() const {
  return innovations_.size() == kWindows && innovations_.back() <= kChi2 &&
         scale_covariance_(0, 0) <= kKnownScaleSigma * kKnownScaleSigma;
}

}  // namespace rds::tracker
