// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/sensors/gyroscope.hpp"

#include <cmath>

#include "tools/simulator/rendering/random.hpp"

namespace rds::simulator {
namespace {

constexpr std::uint64_t kStream = 4001;
constexpr double kNsPerSecond = 1e9;

}  // namespace

std::vector<TurnRate> gyroscope(std::span<const geometry::StampedPose> truth, const GyroscopeErrors& errors,
                                std::uint64_t seed) {
  std::vector<TurnRate> told;
  if (truth.empty()) return told;
  Random random(seed, kStream);
  Eigen::Vector3d bias = errors.bias_rad_per_s * random.normal_vector();
  const Eigen::Vector3d scale = Eigen::Vector3d::Ones() + errors.scale * random.normal_vector();
  const double step_s = 1 / errors.rate_hz;
  const auto step_ns = static_cast<std::int64_t>(step_s * kNsPerSecond);
  for (std::int64_t at = truth.front().stamp_ns; at < truth.back().stamp_ns; at += step_ns) {
    const Eigen::Matrix3d before = geometry::interpolate(truth, at - step_ns / 2).linear();
    const Eigen::Matrix3d after = geometry::interpolate(truth, at + step_ns / 2).linear();
    const Eigen::AngleAxisd turn(Eigen::Matrix3d(before.transpose() * after));
    const Eigen::Vector3d rate = turn.angle() / step_s * turn.axis();
    bias += errors.bias_walk * std::sqrt(step_s) * random.normal_vector();
    told.push_back({at + errors.delay_ns, scale.cwiseProduct(rate) + bias +
                                              errors.noise / std::sqrt(step_s) * random.normal_vector()});
  }
  return told;
}

}  // namespace rds::simulator
