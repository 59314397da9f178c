// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/doctor/checks/frame_look.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <opencv2/imgproc.hpp>

namespace rds::doctor {
namespace {
constexpr int kWidestPx = 640;  // more pixels than a lens resolves look blurred
constexpr int kEvery = 4;       // pixel of a row, row of a depth picture

struct Measurements {
  std::vector<float> ascending_raw;
  std::size_t looked_at = 0;
};

Measurements sample(const image::DepthImage& depth) {
  Measurements result;
  for (int y = 0; y < depth.values.rows; y += kEvery)
    for (int x = 0; x < depth.values.cols; x += kEvery, ++result.looked_at)
      if (const float z = depth.at(x, y); z > 0)
        result.ascending_raw.push_back(std::round(z / depth.metres_per_unit));
  std::ranges::sort(result.ascending_raw);
  return result;
}

/// The longest run of one value.
void find_commonest(const std::vector<float>& ascending, DepthLook& look) {
  std::size_t longest = 0;
  for (auto first = ascending.begin(); first != ascending.end();) {
    const auto last = std::upper_bound(first, ascending.end(), *first);
    if (const auto run = static_cast<std::size_t>(last - first); run > longest) {
      longest = run;
      look.commonest_raw = *first;
    }
    first = last;
  }
  look.commonest = static_cast<double>(longest) / static_cast<double>(ascending.size());
}

}  // namespace

ColorLook look_at_color(const cv::Mat& picture) {
  cv::Mat gray = picture;
  if (const double shrink = static_cast<double>(kWidestPx) / picture.cols; shrink < 1)
    cv::resize(picture, gray, {}, shrink, shrink, cv::INTER_AREA);
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(gray, mean, deviation);
  ColorLook look{mean[0], deviation[0], 0};
  cv::Mat laplacian;
  cv::Laplacian(gray, laplacian, CV_16S);
  cv::meanStdDev(laplacian, mean, deviation);
  if (look.contrast > 0) look.sharpness = deviation[0] * deviation[0] / (look.contrast * look.contrast);
  return look;
}

DepthLook look_at_depth(const image::DepthImage& depth) {
  const auto [raw, looked_at] = sample(depth);
  DepthLook look;
  if (raw.empty()) return look;
  look.measured = static_cast<double>(raw.size()) / static_cast<double>(looked_at);
  const auto metres = [&raw = raw, &depth](std::size_t percent) {
    return static_cast<double>(raw[(raw.size() - 1) * percent / 100] * depth.metres_per_unit);
  };
  look.near_m = metres(1);
  look.median_m = metres(50);
  look.far_m = metres(99);
  find_commonest(raw, look);
  return look;
}

}  // namespace rds::doctor
