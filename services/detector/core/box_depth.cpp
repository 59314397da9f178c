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

struct PixelRange {
  int first = 0;
  int last = -1;  // inclusive
  int step = 1;
};

/// The pixels of [low, high) that lie inside the image, reduced to its central part, thinned to
/// kSamplesPerAxis.
PixelRange central_range(double low, double high, double part, int size) {
  const double center = (low + high) / 2;
  const double half = (high - low) / 2 * part;
  const double first = std::clamp(std::floor(center - half), 0.0, static_cast<double>(size));
  const double last = std::clamp(std::ceil(center + half), 0.0, static_cast<double>(size)) - 1;
  const int count = static_cast<int>(last - first) + 1;
  return {static_cast<int>(first), static_cast<int>(last), std::max(1, count / kSamplesPerAxis)};
}

struct Samples {
  std::vector<float> depths_m;  // valid ones, ascending
  std::size_t looked_at = 0;
};

Samples sample(const image::DepthImage& depth, const geometry::Box2& box, const BoxDepthConfig& config) {
  const PixelRange xs = central_range(box.x0, box.x1, config.central_part, depth.values.cols);
  const PixelRange ys = central_range(box.y0, box.y1, config.central_part, depth.values.rows);
  Samples samples;
  for (int y = ys.first; y <= ys.last; y += ys.step)
    for (int x = xs.first; x <= xs.last; x += xs.step) {
      ++samples.looked_at;
      const float d = depth.at(x, y);
      if (d > 0 && static_cast<double>(d) <= config.max_depth_m) samples.depths_m.push_back(d);
    }
  std::ranges::sort(samples.depths_m);
  return samples;
}

/// How many of the ascending depths lie within `extent_m` behind each of them.
std::vector<std::size_t> fill_of_intervals(std::span<const float> depths_m, double extent_m) {
  std::vector<std::size_t> fill(depths_m.size());
  std::size_t end = 0;
  for (std::size_t begin = 0; begin < depths_m.size(); ++begin) {
    while (end < depths_m.size() && static_cast<double>(depths_m[end] - depths_m[begin]) <= extent_m) ++end;
    fill[begin] = end - begin;
  }
  return fill;
}

/// The object's depths: the nearest interval that is locally fullest and at least `nearer_surface` as full as
/// the fullest.
std::span<const float> object_surface(std::span<const float> depths_m, const BoxDepthConfig& config) {
  const auto fill = fill_of_intervals(depths_m, config.object_extent_m);
  const std::size_t fullest = *std::ranges::max_element(fill);
  const auto enough =
      static_cast<std::size_t>(std::ceil(config.nearer_surface * static_cast<double>(fullest)));
  std::size_t begin = 0;
  while (fill[begin] < enough) ++begin;
  // Go on to the fullest interval that still overlaps the first one that is full enough.
  const std::size_t overlap_end = begin + fill[begin];
  for (std::size_t i = begin + 1; i < overlap_end; ++i)
    if (fill[i] > fill[begin]) begin = i;
  return depths_m.subspan(begin, fill[begin]);
}

}  // namespace

void read(config::ConfigReader& reader, BoxDepthConfig& config) {
  reader.value("central_part", config.central_part, 0.05, 1.0);
  reader.value("object_extent_m", config.object_extent_m, 0.05, 5.0, "m");
  reader.value("nearer_surface", config.nearer_surface, 0.0, 1.0);
  reader.value("min_valid", config.min_valid, 0.0, 1.0);
  reader.value("max_depth_m", config.max_depth_m, 0.1, 1000.0, "m");
}

float box_depth(const image::DepthImage& depth, const geometry::Box2& box, const BoxDepthConfig& config) {
  const bool usable = depth.values.type() == CV_16UC1 || depth.values.type() == CV_32FC1;
  const bool finite = std::isfinite(box.x0 + box.y0 + box.x1 + box.y1);
  if (depth.values.empty() || !usable || !finite || box.area() <= 0) return 0;
  const Samples samples = sample(depth, box, config);
  const double needed = config.min_valid * static_cast<double>(samples.looked_at);
  if (samples.depths_m.size() < kFewestSamples || static_cast<double>(samples.depths_m.size()) < needed)
    return 0;
  const auto surface = object_surface(samples.depths_m, config);
  return (surface[surface.size() / 2] + surface[surface.size() / 3]) / 2;
}

}  // namespace rds::detector
