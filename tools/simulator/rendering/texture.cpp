// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/rendering/texture.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace rds::simulator {
namespace {

int power_of_two(int size) {
  return static_cast<int>(std::bit_ceil(static_cast<unsigned>(std::clamp(size, 4, 1024))));
}

/// log2 of a positive number, within 0.01: exponent bits plus a parabola for the mantissa.
float fast_log2(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x);
  const float exponent = static_cast<float>(static_cast<int>(bits >> 23U) - 127);
  const float mantissa = std::bit_cast<float>((bits & 0x007FFFFFU) | 0x3F800000U) - 1.0F;
  return exponent + mantissa * (1.3465F - 0.3465F * mantissa);
}

}  // namespace

Texture::Texture(const cv::Mat& bgr) {
  cv::Mat level;
  const cv::Size size(power_of_two(bgr.cols), power_of_two(bgr.rows));
  if (size == bgr.size())
    level = bgr;
  else
    cv::resize(bgr, level, size, 0, 0, cv::INTER_LINEAR);
  size_ = std::sqrt(static_cast<float>(size.width) * static_cast<float>(size.height));
  while (true) {
    Level out{level.cols, level.rows, {}};
    out.pixels.reserve(level.total());
    for (int y = 0; y < level.rows; ++y)
      for (int x = 0; x < level.cols; ++x) {
        const auto& p = level.at<cv::Vec3b>(y, x);
        out.pixels.push_back(static_cast<std::uint32_t>(p[0] | p[1] << 8 | p[2] << 16));
      }
    levels_.push_back(std::move(out));
    if (level.cols == 1 && level.rows == 1) break;
    cv::Mat half;
    cv::resize(level, half, cv::Size(std::max(1, level.cols / 2), std::max(1, level.rows / 2)), 0, 0,
               cv::INTER_AREA);
    level = half;
  }
}

Eigen::Array3f Texture::bilinear(const Level& level, float u, float v) {
  const float x = u * static_cast<float>(level.width) - 0.5F;
  const float y = v * static_cast<float>(level.height) - 0.5F;
  const float x_floor = std::floor(x);
  const float y_floor = std::floor(y);
  const int x0 = static_cast<int>(x_floor) & (level.width - 1);
  const int y0 = static_cast<int>(y_floor) & (level.height - 1);
  const int x1 = (x0 + 1) & (level.width - 1);
  const int y1 = (y0 + 1) & (level.height - 1);
  const float fx = x - x_floor;
  const float fy = y - y_floor;
  const auto texel = [&level](int tx, int ty) {
    const std::uint32_t p =
        level.pixels[static_cast<std::size_t>(ty) * static_cast<std::size_t>(level.width) +
                     static_cast<std::size_t>(tx)];
    return Eigen::Array3f(static_cast<float>(p & 255U), static_cast<float>(p >> 8U & 255U),
                          static_cast<float>(p >> 16U & 255U));
  };
  const Eigen::Array3f top = texel(x0, y0) * (1 - fx) + texel(x1, y0) * fx;
  const Eigen::Array3f bottom = texel(x0, y1) * (1 - fx) + texel(x1, y1) * fx;
  return top * (1 - fy) + bottom * fy;
}

Eigen::Array3f Texture::sample(float u, float v, float footprint) const {
  const float lod = fast_log2(std::max(footprint * size_, 1e-3F));
  const float last = static_cast<float>(levels_.size() - 1);
  const float wanted = std::clamp(lod, 0.0F, last);
  const auto fine = static_cast<std::size_t>(wanted);
  const float blend = wanted - static_cast<float>(fine);
  Eigen::Array3f a = bilinear(levels_[fine], u, v);
  if (blend < 0.02F || fine + 1 >= levels_.size()) return a;
  return a * (1 - blend) + bilinear(levels_[fine + 1], u, v) * blend;
}

}  // namespace rds::simulator
