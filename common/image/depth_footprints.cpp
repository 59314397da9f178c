// SPDX-License-Identifier: Apache-2.0
#include "common/image/depth_footprints.hpp"

#include <algorithm>
#include <array>

namespace rds::image {
namespace {

using Floats = DepthFootprints::Floats;

/// Brown–Conrady distortion, as geometry::CameraModel has it.
void distort(const std::array<double, 5>& coefficients, Floats& x, Floats& y) {
  const Eigen::Array<float, 5, 1> k =
      Eigen::Map<const Eigen::Array<double, 5, 1>>(coefficients.data()).cast<float>();
  const Floats r2 = x.square() + y.square();
  const Floats radial = 1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
  const Floats xy = x * y;
  const Floats bent_x = x * radial + 2 * k[2] * xy + k[3] * (r2 + 2 * x.square());
  y = y * radial + k[2] * (r2 + 2 * y.square()) + 2 * k[3] * xy;
  x = bent_x;
}

/// Of the corners of its picture, and a little more.
float widest_ray2(const geometry::CameraModel& camera) {
  double widest = 0;
  for (const double x : {-0.5, camera.width - 0.5})
    for (const double y : {-0.5, camera.height - 0.5})
      widest = std::max(widest, camera.ray({x, y}).head<2>().squaredNorm());
  return static_cast<float>(1.1 * widest);
}

}  // namespace

DepthFootprints::DepthFootprints(const geometry::CameraModel& target,
                                 const geometry::Pose& target_from_source)
    : target_(target),
      turn_(target_from_source.linear().cast<float>()),
      shift_(target_from_source.translation().cast<float>()),
      spread_(turn_.topLeftCorner<2, 2>().cwiseAbs().rowwise().sum().maxCoeff()),
      widest_ray2_(widest_ray2(target)) {}

void DepthFootprints::place(const Floats& metres, const Rays& rays) {
  const auto moved = [&](int axis) {
    return metres * (turn_(axis, 0) * rays.x + turn_(axis, 1) * rays.y + turn_(axis, 2)) + shift_[axis];
  };
  z_ = moved(2);
  per_z_ = z_.max(kNearestM).inverse();
  x_ = moved(0) * per_z_;
  y_ = moved(1) * per_z_;
  if (target_.has_distortion()) bend();
  z_ = (metres * rays.half > 0).select(z_, 0.0F);
  reach_ = kWider * spread_ * rays.half * metres * per_z_;
  cover(x_, target_.fx, target_.cx, target_.width, columns_);
  cover(y_, target_.fy, target_.cy, target_.height, rows_);
}

/// By the target's lens, where it has rays.
void DepthFootprints::bend() {
  z_ = (x_.square() + y_.square() < widest_ray2_).select(z_, 0.0F);
  x_ = (z_ > 0).select(x_, 0.0F);
  y_ = (z_ > 0).select(y_, 0.0F);
  distort(target_.distortion, x_, y_);
}

/// Pixels whose middle is within reach of a measurement.
void DepthFootprints::cover(Floats& at, double focal, double center, int size, Span& span) {
  const auto f = static_cast<float>(focal);
  const auto most = static_cast<float>(size);
  reach_px_ = (f * reach_).min(kWidestPx);
  at = f * at + (static_cast<float>(center) + 1);
  span.first = (at - reach_px_).max(0.0F).min(most).cast<int>();
  span.end = (at + reach_px_).max(0.0F).min(most).cast<int>();
}

}  // namespace rds::image
