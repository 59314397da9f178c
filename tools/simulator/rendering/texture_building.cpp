// SPDX-License-Identifier: Apache-2.0
// Walls and floors of corridors: little texture, but none is without.
#include <opencv2/imgproc.hpp>

#include "tools/simulator/rendering/texture_paint.hpp"

namespace rds::simulator::paint {
namespace {

constexpr int kSide = 1024;

/// Strews small ellipses; each has the ground's colour times a number from `darkest` to `brightest`.
void strew(cv::Mat& image, Random& random, const cv::Scalar& ground, int count, int largest_px,
           double darkest, double brightest) {
  for (int i = 0; i < count; ++i) {
    const cv::Point center(random.integer(kSide), random.integer(kSide));
    const cv::Size axes(2 + random.integer(largest_px - 1), 2 + random.integer(largest_px - 1));
    cv::ellipse(image, center, axes, random.uniform(0, 180), 0, 360,
                ground * random.uniform(darkest, brightest), -1, cv::LINE_AA);
  }
}

}  // namespace

cv::Mat plaster(Random& random, const cv::Scalar& color) {
  cv::Mat image = speckled(random, {kSide, kSide}, color, 5, 4);
  strew(image, random, color, 420, 8, 0.84, 0.96);
  return image;
}

cv::Mat terrazzo(Random& random, const cv::Scalar& color) {
  cv::Mat image = speckled(random, {kSide, kSide}, color, 6, 5);
  strew(image, random, color, 2600, 8, 0.7, 1.2);
  return image;
}

}  // namespace rds::simulator::paint
