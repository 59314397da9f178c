// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/prediction/sort/box_filter.hpp"

#include <cmath>

#include <Eigen/LU>

namespace rds::tracker::prediction {
namespace {

using Matrix7 = Eigen::Matrix<double, 7, 7>;
using Vector7 = Eigen::Matrix<double, 7, 1>;
using Matrix47 = Eigen::Matrix<double, 4, 7>;

// Noise as published with SORT.
const Vector7 kInitialVariance = (Vector7() << 10, 10, 10, 10, 1e4, 1e4, 1e4).finished();
const Vector7 kProcessVariance = (Vector7() << 1, 1, 1, 1, 1e-2, 1e-2, 1e-4).finished();
const Eigen::Vector4d kMeasurementVariance(1, 1, 10, 10);

Eigen::Vector4d to_measurement(const geometry::Box2& box) {
  return {(box.x0 + box.x1) / 2, (box.y0 + box.y1) / 2, box.area(), box.width() / box.height()};
}

}  // namespace

BoxFilter::BoxFilter(const geometry::Box2& box) : covariance_(kInitialVariance.asDiagonal()) {
  state_.head<4>() = to_measurement(box);
}

void BoxFilter::predict(double frames) {
  if (state_(2) + frames * state_(6) <= 0) state_(6) = 0;  // an area stays positive
  Matrix7 transition = Matrix7::Identity();
  transition.topRightCorner<3, 3>().diagonal().setConstant(frames);
  state_ = transition * state_;
  covariance_ = transition * covariance_ * transition.transpose();
  covariance_.diagonal() += frames * kProcessVariance;
}

void BoxFilter::correct(const geometry::Box2& box) {
  Matrix47 observe = Matrix47::Zero();
  observe.leftCols<4>().setIdentity();
  const Eigen::Matrix4d noise = kMeasurementVariance.asDiagonal();
  const Eigen::Matrix4d innovation = covariance_.topLeftCorner<4, 4>() + noise;
  const Eigen::Matrix<double, 7, 4> gain = covariance_.leftCols<4>() * innovation.inverse();
  state_ += gain * (to_measurement(box) - state_.head<4>());
  const Matrix7 keep = Matrix7::Identity() - gain * observe;
  covariance_ = keep * covariance_ * keep.transpose() + gain * noise * gain.transpose();  // Joseph's form
}

geometry::Box2 BoxFilter::box() const {
  const double width = std::sqrt(state_(2) * state_(3));
  const double height = state_(2) / width;
  return {state_(0) - width / 2, state_(1) - height / 2, state_(0) + width / 2, state_(1) + height / 2};
}

}  // namespace rds::tracker::prediction
