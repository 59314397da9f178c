// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/calibration/depth_delay.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace rds::tracker {
namespace {

constexpr double kStepS = 0.01;        // between the delays that are compared
constexpr int kStridePx = 2;           // of the depth picture that is searched for edges
constexpr float kEdge = 0.15F;         // step between neighbours, as a share of the nearer one's depth
constexpr float kFarthestM = 3;        // beyond, noise makes edges
constexpr float kStrongest = 100;      // of an edge in colour: few very strong ones say no more than others
constexpr double kSlowestPxPerS = 300; // of the picture's middle: a step of the delays is 3 px then
constexpr std::size_t kFewestEdges = 200;
constexpr int kFewestPictures = 10;
constexpr double kSignificant = 4;  // standard errors

/// Where something near ends, in the depth camera's frame.
std::vector<Eigen::Vector3d> edges_of(const image::DepthImage& depth, const geometry::CameraModel& camera) {
  std::vector<Eigen::Vector3d> edges;
  const auto add = [&](int x, int y, float here, int other_x, int other_y) {
    const float there = depth.at(other_x, other_y);
    if (!(there > 0) || std::abs(here - there) < kEdge * std::min(here, there)) return;
    const bool is_here = here < there;
    const float nearer = is_here ? here : there;
    if (nearer < kFarthestM)
      edges.push_back(double{nearer} * camera.ray({is_here ? x : other_x, is_here ? y : other_y}));
  };
  for (int y = 0; y + kStridePx < camera.height; y += kStridePx)
    for (int x = 0; x + kStridePx < camera.width; x += kStridePx) {
      const float here = depth.at(x, y);
      if (!(here > 0)) continue;
      add(x, y, here, x + kStridePx, y);
      add(x, y, here, x, y + kStridePx);
    }
  return edges;
}

/// Strength of the edge in a grey picture at a place of its level; nullopt outside.
std::optional<float> edge_at(const ImagePyramid& grey, int level, const Eigen::Vector2d& px) {
  const Eigen::Vector2f at = ImagePyramid::at_level(px.cast<float>(), level);
  if (!grey.contains(at, 2, level)) return std::nullopt;
  const cv::Mat& image = grey.level(level);
  const int x = static_cast<int>(at.x() + 0.5F);
  const int y = static_cast<int>(at.y() + 0.5F);
  const auto value = [&](int column, int row) { return static_cast<float>(image.at<std::uint8_t>(row, column)); };
  return std::min(kStrongest, std::hypot(value(x + 1, y) - value(x - 1, y), value(x, y + 1) - value(x, y - 1)));
}

}  // namespace

double DepthDelay::at(std::size_t i) {
  return (static_cast<double>(i) - static_cast<double>(kDelays / 2)) * kStepS;
}

void DepthDelay::observe(const ImagePyramid& grey, const image::DepthImage& depth,
                         const geometry::CameraModel& camera, const Twist& velocity, double offset_s) {
  if (velocity.tail<3>().head<2>().norm() * camera.fx < kSlowestPxPerS) return;
  const std::vector<Eigen::Vector3d> edges = edges_of(depth, camera);
  if (edges.size() < kFewestEdges) return;
  const int level = std::min(1, grey.levels() - 1);
  Curve strength{};
  for (std::size_t i = 0; i < kDelays; ++i) {
    const geometry::Pose color_from_depth = se3_exp(velocity * -(offset_s + at(i)));
    double seen = 0;
    for (const Eigen::Vector3d& edge : edges) {
      const Eigen::Vector3d p = color_from_depth * edge;
      const auto found = p.z() > 0 ? edge_at(grey, level, camera.project(p)) : std::nullopt;
      if (!found) continue;
      strength[i] += *found;
      ++seen;
    }
    if (seen > 0) strength[i] /= seen;
  }
  add(strength);
}

void DepthDelay::add(const Curve& strength) {
  double mean = 0;
  for (const double s : strength) mean += s / kDelays;
  if (!(mean > 0)) return;
  ++pictures_;
  for (std::size_t i = 0; i < kDelays; ++i) {
    const double more = (strength[i] - strength[kDelays / 2]) / mean;
    sum_[i] += more;
    squares_[i] += more * more;
  }
  delay_s_ = strongest();
}

/// The top of the parabola through the strongest delay and its neighbours.
double DepthDelay::strongest() const {
  const auto i = static_cast<std::size_t>(std::ranges::max_element(sum_) - sum_.begin());
  if (pictures_ < kFewestPictures || i == kDelays / 2 || i == 0 || i == kDelays - 1) return 0;
  const double mean = sum_[i] / pictures_;
  const double variance = squares_[i] / pictures_ - mean * mean;
  if (mean < kSignificant * std::sqrt(variance / pictures_)) return 0;
  const double curvature = sum_[i - 1] - 2 * sum_[i] + sum_[i + 1];
  return at(i) + kStepS * (sum_[i - 1] - sum_[i + 1]) / (2 * curvature);
}

}  // namespace rds::tracker
