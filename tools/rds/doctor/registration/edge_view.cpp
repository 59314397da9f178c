// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "tools/rds/doctor/registration/depth_registration.hpp"

namespace rds::doctor {
namespace {
constexpr int kWidth = 320;
constexpr double kClip = 0.9;   // share of the pixels with a gradient below 1
constexpr float kJump = 1.08F;  // steps of a slanted floor stay below it
constexpr std::size_t kMostEdges = 300;

/// The value below which `share` of the pixels lie.
float quantile(const cv::Mat& values, double share) {
  std::vector<float> sorted(values.begin<float>(), values.end<float>());
  const auto place =
      sorted.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(sorted.size() - 1));
  std::nth_element(sorted.begin(), place, sorted.end());
  return *place;
}

cv::Mat gradient_of(const cv::Mat& gray, double shrink) {
  cv::Mat small;
  cv::resize(gray, small, {}, shrink, shrink, cv::INTER_AREA);
  cv::GaussianBlur(small, small, {}, 1.0);
  cv::Mat dx;
  cv::Mat dy;
  cv::Sobel(small, dx, CV_32F, 1, 0);
  cv::Sobel(small, dy, CV_32F, 0, 1);
  cv::Mat strength;
  cv::magnitude(dx, dy, strength);
  cv::Mat clipped = cv::min(strength / std::max(1.0F, quantile(strength, kClip)), 1.0);
  return clipped;
}

std::vector<cv::Point> depth_edges_of(const cv::Mat& depth) {
  cv::Mat values;
  depth.convertTo(values, CV_32F);
  cv::Mat farthest;  // of the pixel and its neighbours
  cv::dilate(values, farthest, cv::Mat::ones(3, 3, CV_8U));
  const cv::Mat is_edge = (values > 0) & (farthest > kJump * values);
  std::vector<cv::Point> edges;
  cv::findNonZero(is_edge, edges);
  return edges;
}

}  // namespace

EdgeView find_edges(const cv::Mat& gray, const cv::Mat& depth) {
  EdgeView view;
  view.shrink = std::min(1.0, static_cast<double>(kWidth) / gray.cols);
  view.gradient = gradient_of(gray, view.shrink);
  const auto edges = depth_edges_of(depth);
  const std::size_t kept = std::min(edges.size(), kMostEdges);
  for (std::size_t i = 0; i < kept; ++i) view.depth_edges.emplace_back(edges[i * edges.size() / kept]);
  return view;
}

}  // namespace rds::doctor
