// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/rendering/lens.hpp"

#include <cmath>
#include <stdexcept>

#include <Eigen/Geometry>
#include <opencv2/imgproc.hpp>

namespace rds::simulator {
namespace {

constexpr double kInverted = 1e-3;  // px that a pixel may be off after there and back
constexpr double kLargest = 2;      // times the picture, that the rendered one may be

}  // namespace

Lens::Lens(const geometry::CameraModel& camera) : ideal_(camera) {
  if (!camera.has_distortion()) return;
  from_x_.create(camera.height, camera.width, CV_32FC1);
  from_y_.create(camera.height, camera.width, CV_32FC1);
  Eigen::AlignedBox2d seen;
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const Eigen::Vector2d px(x, y);
      const Eigen::Vector2d from = camera.undistort(px);
      const Eigen::Vector2d back = camera.project(camera.ray_of_undistorted(from));
      if (!((back - px).norm() < kInverted))
        throw std::invalid_argument("lens: the distortion cannot be inverted everywhere in the picture");
      from_x_.at<float>(y, x) = static_cast<float>(from.x());
      from_y_.at<float>(y, x) = static_cast<float>(from.y());
      seen.extend(from);
    }
  if (seen.sizes().x() > kLargest * camera.width || seen.sizes().y() > kLargest * camera.height)
    throw std::invalid_argument("lens: the distortion spreads the picture too far");
  const Eigen::Vector2d corner = seen.min().array().floor();
  ideal_.distortion = {};
  ideal_.width = static_cast<int>(std::ceil(seen.max().x() - corner.x())) + 1;
  ideal_.height = static_cast<int>(std::ceil(seen.max().y() - corner.y())) + 1;
  ideal_.cx -= corner.x();
  ideal_.cy -= corner.y();
  from_x_ -= corner.x();
  from_y_ -= corner.y();
}

void Lens::distort(cv::Mat& picture, int interpolation) const {
  if (from_x_.empty()) return;
  cv::Mat seen;
  cv::remap(picture, seen, from_x_, from_y_, interpolation, cv::BORDER_REPLICATE);
  picture = seen;
}

}  // namespace rds::simulator
