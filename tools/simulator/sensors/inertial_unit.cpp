// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/sensors/inertial_unit.hpp"

#include <cmath>

#include "tools/simulator/rendering/random.hpp"

namespace rds::simulator {
namespace {

constexpr std::uint64_t kStream = 4002;
constexpr double kNsPerSecond = 1e9;
constexpr double kStandardGravity = 9.81;  // m/s²

/// Of the camera, in its axes, with gravity's reaction; by the difference of speeds.
Eigen::Vector3d acceleration(std::span<const geometry::StampedPose> truth, std::int64_t at_ns,
                             std::int64_t step_ns) {
  const auto place = [&](std::int64_t ns) -> Eigen::Vector3d {
    return geometry::interpolate(truth, ns).translation();
  };
  const double step_s = static_cast<double>(step_ns) / kNsPerSecond;
  const Eigen::Vector3d in_world =
      (place(at_ns + step_ns) - 2 * place(at_ns) + place(at_ns - step_ns)) / (step_s * step_s) +
      kStandardGravity * Eigen::Vector3d::UnitZ();
  return geometry::interpolate(truth, at_ns).linear().transpose() * in_world;
}

}  // namespace

image::ImuTrack inertial_unit(std::span<const geometry::StampedPose> truth, const InertialErrors& errors,
                              std::uint64_t seed) {
  image::ImuTrack track;
  Random random(seed, kStream);
  const Eigen::Vector3d bias = errors.bias_m_per_s2 * random.normal_vector();
  const double rate_hz = errors.gyroscope.rate_hz;
  const auto step_ns = static_cast<std::int64_t>(kNsPerSecond / rate_hz);
  for (const TurnRate& rate : gyroscope(truth, errors.gyroscope, seed)) {
    const std::int64_t at_ns = rate.stamp_ns - errors.gyroscope.delay_ns;
    if (at_ns - step_ns < truth.front().stamp_ns || at_ns + step_ns > truth.back().stamp_ns) continue;
    track.measurements.push_back({rate.stamp_ns,
                                  acceleration(truth, at_ns, step_ns) + bias +
                                      errors.noise * std::sqrt(rate_hz) * random.normal_vector(),
                                  rate.rad_per_s});
  }
  return track;
}

}  // namespace rds::simulator
