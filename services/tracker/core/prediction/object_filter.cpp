// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/prediction/object_filter.hpp"

#include <Eigen/LU>

namespace rds::tracker::prediction {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Matrix63 = Eigen::Matrix<double, 6, 3>;

double square(double x) {
  return x * x;
}

Eigen::Matrix3d measurement_noise(const Eigen::Matrix3d& map_from_box, const Kalman3dConfig& config) {
  const Eigen::Vector3d variance(square(config.lateral_noise_m), square(config.lateral_noise_m),
                                 square(config.depth_noise_m));
  return map_from_box * variance.asDiagonal() * map_from_box.transpose();
}

}  // namespace

ObjectFilter::ObjectFilter(const geometry::OrientedBox& box, const Kalman3dConfig& config)
    : size_(box.size),
      size_variance_(Eigen::Vector3d::Constant(square(config.size_noise_m))),
      map_from_box_(box.map_from_box.linear()) {
  state_.head<3>() = box.center();
  covariance_.topLeftCorner<3, 3>() = measurement_noise(map_from_box_, config);
  covariance_.bottomRightCorner<3, 3>().diagonal().setConstant(square(config.initial_speed));
}

void ObjectFilter::predict(double seconds, const Kalman3dConfig& config) {
  Matrix6 transition = Matrix6::Identity();
  transition.topRightCorner<3, 3>().diagonal().setConstant(seconds);
  state_ = transition * state_;
  covariance_ = transition * covariance_ * transition.transpose();
  const double q = square(config.acceleration);  // white noise: ∫ F G q Gᵀ Fᵀ dt
  covariance_.topLeftCorner<3, 3>().diagonal().array() += q * seconds * seconds * seconds / 3;
  covariance_.topRightCorner<3, 3>().diagonal().array() += q * seconds * seconds / 2;
  covariance_.bottomLeftCorner<3, 3>().diagonal().array() += q * seconds * seconds / 2;
  covariance_.bottomRightCorner<3, 3>().diagonal().array() += q * seconds;
  size_variance_.array() += square(config.size_drift) * seconds;
}

void ObjectFilter::correct(const geometry::OrientedBox& box, const Kalman3dConfig& config) {
  map_from_box_ = box.map_from_box.linear();
  const Eigen::Matrix3d noise = measurement_noise(map_from_box_, config);
  const Eigen::Matrix3d innovation = center_covariance() + noise;
  const Matrix63 gain = covariance_.leftCols<3>() * innovation.inverse();
  state_ += gain * (box.center() - center());
  Matrix6 keep = Matrix6::Identity();
  keep.leftCols<3>() -= gain;
  covariance_ = keep * covariance_ * keep.transpose() + gain * noise * gain.transpose();  // Joseph's form
  const Eigen::Array3d size_gain =
      size_variance_.array() / (size_variance_.array() + square(config.size_noise_m));
  size_.array() += size_gain * (box.size - size_).array();
  size_variance_.array() *= 1 - size_gain;
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
