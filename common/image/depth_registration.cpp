// SPDX-License-Identifier: Apache-2.0
#include "common/image/depth_registration.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <type_traits>

#include "common/image/depth_footprints.hpp"

namespace rds::image {
namespace {

using Floats = DepthFootprints::Floats;

template <class Value>
Eigen::Map<const Eigen::Array<Value, 1, Eigen::Dynamic>> row_of(const cv::Mat& picture, int y) {
  return {picture.ptr<Value>(y), picture.cols};
}

/// Of a row of a depth picture [m]; 0 where nothing is measured.
void read_row(const DepthImage& picture, int y, Floats& metres) {
  constexpr float kFarthestM = 1e4F;
  if (picture.values.type() == CV_16UC1) {
    metres = row_of<std::uint16_t>(picture.values, y).cast<float>() * picture.metres_per_unit;
  } else {
    metres = row_of<float>(picture.values, y) * picture.metres_per_unit;
    metres = (metres > 0 && metres < kFarthestM).select(metres, 0.0F);
  }
}

/// Draws the nearest into each pixel; 0 is none.
template <class Value>
void draw(const DepthFootprints& row, float metres_per_unit, cv::Mat& target) {
  constexpr bool kIsWhole = std::is_integral_v<Value>;
  constexpr float kMost = static_cast<float>(std::numeric_limits<Value>::max());
  const float units_per_metre = 1 / metres_per_unit;
  for (Eigen::Index i = 0; i < row.z().size(); ++i) {
    const float units = row.z()[i] * units_per_metre + (kIsWhole ? 0.5F : 0.0F);
    if (row.z()[i] < DepthFootprints::kNearestM || units >= kMost) continue;
    const auto value = static_cast<Value>(units);
    for (int y = row.rows().first[i]; y < row.rows().end[i]; ++y) {
      auto* pixels = target.ptr<Value>(y);
      for (int x = row.columns().first[i]; x < row.columns().end[i]; ++x)
        if (pixels[x] == 0 || value < pixels[x]) pixels[x] = value;
    }
  }
}

}  // namespace

DepthRegistration::DepthRegistration(const geometry::Lens& source, const geometry::CameraModel& target)
    : source_(source),
      target_(target),
      ray_x_(source.height, source.width),
      ray_y_(source.height, source.width),
      half_(source.height, source.width, 0.0F) {
  constexpr float kNoRay = std::numeric_limits<float>::quiet_NaN();
  for (int y = 0; y < source.height; ++y)
    for (int x = 0; x < source.width; ++x) {
      const auto ray = source.ray({x, y});
      ray_x_(y, x) = ray ? static_cast<float>(ray->x()) : kNoRay;
      ray_y_(y, x) = ray ? static_cast<float>(ray->y()) : kNoRay;
    }
  const auto between = [this](int y, int x, int other_y, int other_x) {
    return std::hypot(ray_x_(y, x) - ray_x_(other_y, other_x), ray_y_(y, x) - ray_y_(other_y, other_x));
  };
  for (int y = 0; y < source.height; ++y)
    for (int x = 0; x < source.width; ++x) {
      const float width = between(y, x, y, x + 1 < source.width ? x + 1 : std::max(x - 1, 0));
      const float height = between(y, x, y + 1 < source.height ? y + 1 : std::max(y - 1, 0), x);
      half_(y, x) = std::isfinite(width + height) ? std::max(width, height) / 2 : 0;
    }
  ray_x_.setTo(0, half_ == 0);
  ray_y_.setTo(0, half_ == 0);
}

DepthImage DepthRegistration::depth(const DepthImage& picture,
                                    const geometry::Pose& target_from_source) const {
  const bool is_whole = picture.values.type() == CV_16UC1;
  if (picture.values.size() != ray_x_.size() || (!is_whole && picture.values.type() != CV_32FC1))
    throw std::invalid_argument("depth to register is not of its camera's size, or of another type");
  DepthImage result{.values = cv::Mat::zeros(target_.height, target_.width, picture.values.type()),
                    .metres_per_unit = picture.metres_per_unit,
                    .owner = nullptr};
  DepthFootprints row(target_, target_from_source);
  Floats metres;
  for (int y = 0; y < ray_x_.rows; ++y) {
    read_row(picture, y, metres);
    row.place(metres, {row_of<float>(ray_x_, y), row_of<float>(ray_y_, y), row_of<float>(half_, y)});
    if (is_whole)
      draw<std::uint16_t>(row, picture.metres_per_unit, result.values);
    else
      draw<float>(row, picture.metres_per_unit, result.values);
  }
  return result;
}

}  // namespace rds::image
