// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace rds::tracker {

/// A grey picture and its halvings: level l is the mean over squares of 2^l pixels.
///
/// Places are given in pixels of a level; at_level() and at_picture() convert, with pixel centres at
/// integers.
class ImagePyramid {
 public:
  /// @param gray  CV_8UC1; shared, not copied.
  ImagePyramid(const cv::Mat& gray, int levels);

  /// The same pixels, in memory of bytes() that outlasts it.
  [[nodiscard]] ImagePyramid copied_to(std::uint8_t* memory) const;
  /// Of all levels.
  [[nodiscard]] std::size_t bytes() const;

  [[nodiscard]] int levels() const { return static_cast<int>(levels_.size()); }
  [[nodiscard]] const cv::Mat& level(int l) const { return levels_[static_cast<std::size_t>(l)]; }

  /// Place in level l of a place in the picture, and back.
  [[nodiscard]] static Eigen::Vector2f at_level(const Eigen::Vector2f& picture_px, int l) {
    const float scale = 1.0F / static_cast<float>(1 << l);
    return (picture_px.array() + 0.5F) * scale - 0.5F;
  }
  [[nodiscard]] static Eigen::Vector2f at_picture(const Eigen::Vector2f& level_px, int l) {
    return (level_px.array() + 0.5F) * static_cast<float>(1 << l) - 0.5F;
  }

  /// True if the square of half side `radius` around a place of level l can be interpolated.
  [[nodiscard]] bool contains(const Eigen::Vector2f& level_px, float radius, int l) const {
    const cv::Mat& image = level(l);
    return level_px.x() >= radius && level_px.y() >= radius &&
           level_px.x() + radius + 1 < static_cast<float>(image.cols) &&
           level_px.y() + radius + 1 < static_cast<float>(image.rows);
  }

 private:
  explicit ImagePyramid(std::vector<cv::Mat> levels) : levels_(std::move(levels)) {}

  std::vector<cv::Mat> levels_;
};

/// Bilinear value of an 8-bit image. @pre x, y ≥ 0 and less than size − 1.
inline float interpolate(const cv::Mat& image, float x, float y) {
  const int x0 = static_cast<int>(x);
  const int y0 = static_cast<int>(y);
  const float fx = x - static_cast<float>(x0);
  const float fy = y - static_cast<float>(y0);
  const std::uint8_t* top = image.ptr<std::uint8_t>(y0) + x0;
  const std::uint8_t* bottom = top + image.step[0];
  const float upper = static_cast<float>(top[0]) + fx * static_cast<float>(top[1] - top[0]);
  const float lower = static_cast<float>(bottom[0]) + fx * static_cast<float>(bottom[1] - bottom[0]);
  return upper + fy * (lower - upper);
}

/// Bilinear values of Side × Side pixels of an 8-bit image, the first one at (x, y). @pre as interpolate(),
/// for each of them.
template <int Side>
Eigen::Array<float, Side, Side, Eigen::RowMajor> interpolate_square(const cv::Mat& image, float x, float y) {
  using Row = Eigen::Array<float, 1, Side>;
  using Bytes = Eigen::Map<const Eigen::Array<std::uint8_t, 1, Side>>;
  const int x0 = static_cast<int>(x);
  const int y0 = static_cast<int>(y);
  const float fx = x - static_cast<float>(x0);
  const float fy = y - static_cast<float>(y0);
  const auto row = [&](int r) -> Row {
    const std::uint8_t* p = image.ptr<std::uint8_t>(y0 + r) + x0;
    return (1 - fx) * Bytes(p).template cast<float>() + fx * Bytes(p + 1).template cast<float>();
  };
  Eigen::Array<float, Side, Side, Eigen::RowMajor> values;
  Row upper = row(0);
  for (int r = 0; r < Side; ++r) {
    const Row lower = row(r + 1);
    values.row(r) = (1 - fy) * upper + fy * lower;
    upper = lower;
  }
  return values;
}

}  // namespace rds::tracker
