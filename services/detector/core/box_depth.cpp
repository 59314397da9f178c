// SPDX-License-Identifier: Apache-2.0
#include "services/detector/core/box_depth.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace rds::detector {
namespace {

constexpr int kSamplesPerAxis = 64;
constexpr std::size_t kFewestSamples = 4;
constexpr double kMinValid = 0.05;       // share of the pixels that must have a depth
constexpr double kCentralPart = 0.6;     // of the box's width and height: its margin shows what is behind
constexpr double kObjectExtentM = 0.5;   // depths this near to each other belong to one surface: a person's extent
constexpr double kNearerSurface = 0.4;   // a nearer surface wins with this share of the largest surface's pixels

struct PixelRange {
  int first = 0;
  int last = -1;  // inclusive
  int step = 1;
};

/// The pixels of [low, high) that lie inside the image, reduced to its central part, thinned to
/// kSamplesPerAxis.
PixelRange central_range(double low, double high, int size) {
  const double center = (low + high) / 2;
  const double half = (high - low) / 2 * kCentralPart;
  const double first = std::clamp(std::floor(center - half), 0.0, static_cast<double>(size));
  const double last = std::clamp(std::ceil(center + half), 0.0, static_cast<double>(size)) - 1;
  const int count = static_cast<int>(last - first) + 1;
  return {static_cast<int>(first), static_cast<int>(last), std::max(1, count / kSamplesPerAxis)};
}

struct Samples {
  std::vector<float> depths_m;  // valid ones, ascending
  std::size_t looked_at = 0;
};

Samples sample(const image::DepthImage& depth, const geometry::Box2& box, double max_depth_m) {
  const PixelRange xs = central_range(box.x0, box.x1, depth.values.cols);
  const PixelRange ys = central_range(box.y0, box.y1, depth.values.rows);
  Samples samples;
  for (int y = ys.first; y <= ys.last; y += ys.step)
    for (int x = xs.first; x <= xs.last; x += xs.step) {
      ++samples.looked_at;
      const float d = depth.at(x, y);
      if (d > 0 && static_cast<double>(d) <= max_depth_m) samples.depths_m.push_back(d);
    }
  std::ranges::sort(samples.depths_m);
  return samples;
}

/// How many of the ascending depths lie within kObjectExtentM behind each of them.
std::vector<std::size_t> fill_of_intervals(std::span<const float> depths_m) {
  std::vector<std::size_t> fill(depths_m.size());
  std::size_t end = 0;
  for (std::size_t begin = 0; begin < depths_m.size(); ++begin) {
    while (end < depths_m.size() && static_cast<double>(depths_m[end] - depths_m[begin]) <= kObjectExtentM) ++end;
    fill[begin] = end - begin;
  }
  return fill;
}

/// The object's depths: the nearest interval that is locally fullest and at least kNearerSurface as full as
/// the fullest.
std::span<const float> object_surface(std::span<const float> depths_m) {
  const auto fill = fill_of_intervals(depths_m);
  const std::size_t fullest = *std::ranges::max_element(fill);
  const auto enough = static_cast<std::size_t>(std::ceil(kNearerSurface * static_cast<double>(fullest)));
  std::size_t begin = 0;
  while (fill[begin] < enough) ++begin;
  // Go on to the fullest interval that still overlaps the first one that is full enough.
  const std::size_t overlap_end = begin + fill[begin];
  for (std::size_t i = begin + 1; i < overlap_end; ++i)
    if (fill[i] > fill[begin]) begin = i;
  return depths_m.subspan(begin, fill[begin]);
}

}  // namespace

float box_depth(const image::DepthImage& depth, const geometry::Box2& box, double max_depth_m) {
  const bool usable = depth.values.type() == CV_16UC1 || depth.values.type() == CV_32FC1;
  const bool finite = std::isfinite(box.x0 + box.y0 + box.x1 + box.y1);
  if (depth.values.empty() || !usable || !finite || box.area() <= 0) return 0;
  const Samples samples = sample(depth, box, max_depth_m);
  const double needed = kMinValid * static_cast<double>(samples.looked_at);
  if (samples.depths_m.size() < kFewestSamples || static_cast<double>(samples.depths_m.size()) < needed)
    return 0;
  const auto surface = object_surface(samples.depths_m);
  return (surface[surface.size() / 2] + surface[surface.size() / 3]) / 2;
}

}  // namespace rds::detector
