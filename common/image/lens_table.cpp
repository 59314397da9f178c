// SPDX-License-Identifier: Apache-2.0
#include "common/image/lens_table.hpp"

#include <opencv2/imgproc.hpp>

namespace rds::image {

LensTable::LensTable(const geometry::Lens& source, const geometry::CameraModel& target)
    : source_(source), target_(target) {
  cv::Mat2f exact(target.height, target.width);
  for (int y = 0; y < target.height; ++y)
    for (int x = 0; x < target.width; ++x) {
      const Eigen::Vector2d place = source.project(target.ray({x, y}));
      exact(y, x) = {static_cast<float>(place.x()), static_cast<float>(place.y())};
    }
  cv::convertMaps(exact, cv::noArray(), places_, fractions_, CV_16SC2);
  cv::Mat unused;
  cv::convertMaps(exact, cv::noArray(), nearest_, unused, CV_16SC2, true);
}

ColorImage LensTable::color(const ColorImage& picture) const {
  ColorImage result{.pixels = {}, .order = picture.order, .owner = nullptr};
  cv::remap(picture.pixels, result.pixels, places_, fractions_, cv::INTER_LINEAR, cv::BORDER_CONSTANT);
  return result;
}

DepthImage LensTable::depth(const DepthImage& picture) const {
  DepthImage result{.values = {}, .metres_per_unit = picture.metres_per_unit, .owner = nullptr};
  cv::remap(picture.values, result.values, nearest_, cv::noArray(), cv::INTER_NEAREST, cv::BORDER_CONSTANT);
  return result;
}

}  // namespace rds::image
