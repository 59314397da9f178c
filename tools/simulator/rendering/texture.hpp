// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace rds::simulator {

/// A repeating picture with its mip maps, sampled trilinearly.
class Texture {
 public:
  /// @param bgr  CV_8UC3 of any size; resampled to powers of two.
  explicit Texture(const cv::Mat& bgr);

  /// Colour (B, G, R in 0 … 255) at (u, v), one repetition per unit, v downwards.
  ///
  /// @param footprint  length of a pixel's footprint in texture repetitions; chooses the mip level.
  [[nodiscard]] Eigen::Array3f sample(float u, float v, float footprint) const;

 private:
  struct Level {
    int width = 0;
    int height = 0;
    std::vector<std::uint32_t> pixels;
  };
  [[nodiscard]] static Eigen::Array3f bilinear(const Level& level, float u, float v);

  std::vector<Level> levels_;
  float size_ = 0;  // geometric mean of width and height of level 0 [texel]
};

}  // namespace rds::simulator
