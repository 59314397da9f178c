// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/sensors/color_sensor.hpp"

#include <algorithm>
#include <cmath>

#include "tools/simulator/rendering/random.hpp"

namespace rds::simulator {
namespace {

constexpr float kGain = 1.02F;
constexpr float kVignetting = 0.16F;  // loss of light in the corners
constexpr float kReadNoise = 1.5F;    // standard deviation in the dark [grey levels]
constexpr float kShotNoise = 0.012F;  // grows with brightness
constexpr float kShoulder = 205.0F;   // above this highlights are compressed

float roll_off(float value) {
  if (value <= kShoulder) return value;
  const float room = 252.0F - kShoulder;
  const float over = (value - kShoulder) / room;
  return kShoulder + room * over / (1 + over);
}

}  // namespace

ColorSensor::ColorSensor(std::uint64_t seed) : seed_(hash64(seed ^ 0xC0105ULL)), noise_(seed_, 0) {}

cv::Mat ColorSensor::expose(const cv::Mat& ideal, std::uint64_t frame, double time_s) const {
  const double phase = static_cast<double>(seed_ % 1000) / 100.0;
  const auto exposure = static_cast<float>(1 + 0.035 * std::sin(0.9 * time_s + phase) +
                                           0.02 * std::sin(2.3 * time_s + 2 * phase));
  cv::Mat out(ideal.size(), CV_8UC3);
  const float cx = 0.5F * static_cast<float>(ideal.cols - 1);
  const float cy = 0.5F * static_cast<float>(ideal.rows - 1);
  const float corner = cx * cx + cy * cy;
  for (int y = 0; y < ideal.rows; ++y) {
    const auto* in = ideal.ptr<cv::Vec3f>(y);
    auto* to = out.ptr<cv::Vec3b>(y);
    const float dy = static_cast<float>(y) - cy;
    for (int c = 0; c < 3; ++c) {
      const float* noise = noise_.row(seed_ + 4 * frame + static_cast<std::uint64_t>(c), y);
      for (int x = 0; x < ideal.cols; ++x) {
        const float dx = static_cast<float>(x) - cx;
        const float lens = kGain * exposure * (1 - kVignetting * (dx * dx + dy * dy) / corner);
        const float value = roll_off(in[x][c] * lens);
        const float noisy = value + noise[x % NoiseField::kSize] * (kReadNoise + kShotNoise * value) + 0.5F;
        to[x][c] = static_cast<std::uint8_t>(std::clamp(noisy, 0.0F, 255.0F));
      }
    }
  }
  return out;
}

}  // namespace rds::simulator
