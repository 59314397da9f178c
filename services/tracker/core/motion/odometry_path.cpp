// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/motion/odometry_path.hpp"

namespace rds::tracker {
namespace {

// Standard deviations after one metre, radian or second; they grow with its root. 3 cm of a metre is a wheel
// that slips by a third for 10 cm.
constexpr double kWayPerWayM = 0.03;
constexpr double kTurnPerWayRad = 0.02;
constexpr double kTurnPerTurnRad = 0.03;
// Of a robot that says it stands: it may be pushed, or be lifted.
constexpr double kWayPerSecondM = 0.003;
constexpr double kTurnPerSecondRad = 0.003;

constexpr double square(double value) {
  return value * value;
}

}  // namespace

void OdometryPath::extend(const Twist& step, const OdometryScale& scale, double step_s) {
  Twist scaled = step;
  scaled.head<3>() *= scale[0];
  scaled.tail<3>() *= scale[1];
  const geometry::Pose motion = se3_exp(scaled);
  const Matrix6 back = adjoint(motion.inverse());
  begin_from_end_ = begin_from_end_ * motion;
  by_scale_ = back * by_scale_;
  by_scale_.col(0).head<3>() += step.head<3>();
  by_scale_.col(1).tail<3>() += step.tail<3>();
  const double way_m = scaled.head<3>().norm();
  const double turn_rad = scaled.tail<3>().norm();
  Twist variance;
  variance.head<3>().setConstant(square(kWayPerWayM) * way_m + square(kWayPerSecondM) * step_s);
  variance.tail<3>().setConstant(square(kTurnPerWayRad) * way_m + square(kTurnPerTurnRad) * turn_rad +
                                 square(kTurnPerSecondRad) * step_s);
  noise_ = back * noise_ * back.transpose();
  noise_.diagonal() += variance;
  length_m_ += way_m;
  turned_rad_ += turn_rad;
  duration_s_ += step_s;
}

}  // namespace rds::tracker
