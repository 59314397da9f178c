// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <opencv2/core.hpp>

#include "tools/simulator/sensors/noise_field.hpp"

namespace rds::simulator {

/// A cheap webcam: slow changes of exposure, vignetting, highlights that roll off, noise that grows with
/// brightness.
class ColorSensor {
 public:
  explicit ColorSensor(std::uint64_t seed);

  /// @param ideal  CV_32FC3, BGR, 0 … 255 and above.
  /// @return       CV_8UC3; the same frame number gives the same noise.
  [[nodiscard]] cv::Mat expose(const cv::Mat& ideal, std::uint64_t frame, double time_s) const;

 private:
  std::uint64_t seed_;
  NoiseField noise_;
};

}  // namespace rds::simulator
