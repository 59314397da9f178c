// SPDX-License-Identifier: Apache-2.0
#include "tools/evaluation/objects/upright_iou.hpp"

#include <algorithm>
#include <numbers>
#include <vector>

#include <opencv2/imgproc.hpp>

namespace rds::evaluation {
namespace {

/// From above, around an origin near both boxes, as floats carry no more than seven digits.
cv::RotatedRect seen_from_above(const geometry::OrientedBox& box, const Eigen::Vector3d& origin) {
  const Eigen::Vector3d center = box.center() - origin;
  const Eigen::Matrix3d& axes = box.map_from_box.linear();
  const double yaw_deg = std::atan2(axes(1, 0), axes(0, 0)) * 180 / std::numbers::pi;
  return {cv::Point2f(static_cast<float>(center.x()), static_cast<float>(center.y())),
          cv::Size2f(static_cast<float>(box.size.x()), static_cast<float>(box.size.y())),
          static_cast<float>(yaw_deg)};
}

double common_area(const geometry::OrientedBox& a, const geometry::OrientedBox& b) {
  std::vector<cv::Point2f> corners;
  cv::rotatedRectangleIntersection(seen_from_above(a, a.center()), seen_from_above(b, a.center()), corners);
  if (corners.size() < 3) return 0;
  std::vector<cv::Point2f> in_order;
  cv::convexHull(corners, in_order);
  return cv::contourArea(in_order);
}

}  // namespace

double upright_iou(const geometry::OrientedBox& a, const geometry::OrientedBox& b) {
  const auto top = [](const geometry::OrientedBox& box) { return box.center().z() + box.size.z() / 2; };
  const auto bottom = [](const geometry::OrientedBox& box) { return box.center().z() - box.size.z() / 2; };
  const double height = std::min(top(a), top(b)) - std::max(bottom(a), bottom(b));
  const double volumes = a.size.prod() + b.size.prod();
  if (!(height > 0) || !(volumes > 0)) return 0;
  const double common = common_area(a, b) * height;
  return common / (volumes - common);
}

}  // namespace rds::evaluation
