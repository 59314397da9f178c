// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/sensors/depth_sensor.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/simulator/rendering/random.hpp"

namespace rds::simulator {
namespace {

constexpr double kFocalPx = 525;      // of the infrared camera
constexpr double kBaselineM = 0.075;  // projector to infrared camera
constexpr auto kFocalTimesBaseline = static_cast<float>(kFocalPx * kBaselineM);
constexpr float kDisparityNoise = 0.11F;  // standard deviation [px]
constexpr float kSteps = 8.0F;            // disparity steps per pixel
constexpr float kEdge = 0.035F;           // relative jump in depth that is a rim

/// True where depth jumps within `reach` pixels.
bool near_edge(const cv::Mat& depth, int x, int y, int reach) {
  const float z = depth.at<float>(y, x);
  const std::array<cv::Point, 4> around{cv::Point(x - reach, y), cv::Point(x + reach, y),
                                        cv::Point(x, y - reach), cv::Point(x, y + reach)};
  return std::any_of(around.begin(), around.end(), [&](const cv::Point& p) {
    if (p.x < 0 || p.y < 0 || p.x >= depth.cols || p.y >= depth.rows) return false;
    return std::abs(depth.at<float>(p.y, p.x) - z) > kEdge * z;
  });
}

/// How well the pattern is seen: 1 = frontal, near, light surface; below about .3 the match fails.
float quality(const Rendering& truth, int x, int y) {
  const float z = truth.depth.at<float>(y, x);
  const float grazing = std::min(1.0F, truth.cosine.at<float>(y, x) / 0.22F);
  return truth.infrared.at<float>(y, x) * grazing * (1 - 0.02F * z * z);
}

}  // namespace

DepthSensor::DepthSensor(std::uint64_t seed, double fx, double units_per_metre)
    : seed_(hash64(seed ^ 0xDE97ULL)),
      pixels_per_sensor_pixel_(static_cast<float>(fx / kFocalPx)),
      units_per_metre_(units_per_metre),
      fine_(seed_, 1),
      coarse_(seed_ + 1, 3) {}

double DepthSensor::sigma_m(double z) const {
  const double step = 1.0 / static_cast<double>(kSteps);
  const double disparity = std::hypot(static_cast<double>(kDisparityNoise), step / std::sqrt(12.0));
  return z * z / static_cast<double>(kFocalTimesBaseline) * disparity;
}

cv::Mat DepthSensor::measure(const Rendering& truth, std::uint64_t frame) const {
  const cv::Size size = truth.depth.size();
  cv::Mat out = cv::Mat::zeros(size, CV_16UC1);
  for (int y = 0; y < size.height; ++y) {
    const float* fine = fine_.row(seed_ + 2 * frame, y);
    const float* coarse = coarse_.row(seed_ + 2 * frame + 1, y);
    // The projector stands to the left: a point is dark when something nearer further left reaches over it.
    float reach = -1e9F;
    for (int x = 0; x < size.width; ++x) {
      const float z = truth.depth.at<float>(y, x);
      if (z <= 0) continue;
      const float disparity = kFocalTimesBaseline / z;
      const float projector_x = static_cast<float>(x) + disparity * pixels_per_sensor_pixel_;
      const bool in_shadow = projector_x < reach - 1.5F * pixels_per_sensor_pixel_;
      reach = std::max(reach, projector_x);
      const int n = x % NoiseField::kSize;
      if (in_shadow || quality(truth, x, y) < 0.27F + 0.14F * coarse[n]) continue;
      if (near_edge(truth.depth, x, y, 1) && coarse[n] > -0.9F) continue;
      if (near_edge(truth.depth, x, y, 2) && coarse[n] > 0.5F) continue;
      const float step = std::round((disparity + kDisparityNoise * fine[n]) * kSteps) / kSteps;
      const float measured = kFocalTimesBaseline / std::max(step, 0.5F);
      if (measured < kNearestM || measured > kFarthestM) continue;
      out.at<std::uint16_t>(y, x) =
          static_cast<std::uint16_t>(std::lround(static_cast<double>(measured) * units_per_metre_));
    }
  }
  return out;
}

}  // namespace rds::simulator
