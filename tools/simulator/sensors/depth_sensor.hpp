// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <opencv2/core.hpp>

#include "tools/simulator/rendering/renderer.hpp"
#include "tools/simulator/sensors/noise_field.hpp"

namespace rds::simulator {

/// A structured-light camera like the first Kinect (Khoshelham & Elberink, Sensors 2012): disparity in
/// eighths of a pixel, so that the error grows with z²; holes in the projector's shadow, at rims, at grazing
/// angles, on surfaces that swallow infrared light, and out of range.
class DepthSensor {
 public:
  static constexpr double kUnitsPerMetre = 5000;  // unless asked for otherwise
  static constexpr float kNearestM = 0.45F;
  static constexpr float kFarthestM = 4.8F;

  /// @param fx  of the picture that depth is registered to; the sensor itself has the same resolution always.
  DepthSensor(std::uint64_t seed, double fx, double units_per_metre = kUnitsPerMetre);

  /// @return CV_16UC1, 0 = no measurement; the same frame number gives the same noise.
  [[nodiscard]] cv::Mat measure(const Rendering& truth, std::uint64_t frame) const;
  /// One standard deviation of a measurement at depth z [m], quantisation included.
  [[nodiscard]] double sigma_m(double z) const;

 private:
  std::uint64_t seed_;
  float pixels_per_sensor_pixel_;
  double units_per_metre_;
  NoiseField fine_;    // disparity noise, correlated like the matching window
  NoiseField coarse_;  // where patches drop out and rims run
};

}  // namespace rds::simulator
