// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/picture/map_picture_canvas.hpp"

#include <algorithm>
#include <cmath>

namespace rds::tools {
namespace {

constexpr float kNearest = 0.05F;
constexpr float kInfinitelyFar = 1e9F;
constexpr float kFarOutside = 1e5F;  // [px]
constexpr float kDepthBias = 0.03F;  // lines on a surface are not hidden by it

cv::Vec3b blend(const cv::Vec3b& below, const cv::Vec3f& above, float alpha) {
  cv::Vec3b mixed;
  for (int c = 0; c < 3; ++c)
    mixed[c] = cv::saturate_cast<std::uint8_t>(static_cast<float>(below[c]) * (1 - alpha) + above[c] * alpha);
  return mixed;
}

float cross(const ScreenPoint& a, const ScreenPoint& b, float x, float y) {
  return (b.x() - a.x()) * (y - a.y()) - (b.y() - a.y()) * (x - a.x());
}

}  // namespace

ScreenPoint View::project(const Eigen::Vector3d& point_in_level) const {
  const Eigen::Vector3d p = eye_from_level * (point_in_level - eye_in_level);
  const double scale = is_parallel ? focal_px : focal_px / std::max(p.z(), 1e-3);
  return Eigen::Vector3d(center_px.x + p.x() * scale, center_px.y + p.y() * scale, p.z()).cast<float>();
}

View look_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& target, double focal_px,
             cv::Point2d center_px) {
  const Eigen::Vector3d forward = (target - eye).normalized();
  const Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitZ()).normalized();
  View view;
  view.eye_from_level << right.transpose(), forward.cross(right).transpose(), forward.transpose();
  view.eye_in_level = eye;
  view.focal_px = focal_px;
  view.center_px = center_px;
  return view;
}

View look_down(const Eigen::Vector3d& center, double pixels_per_m, cv::Point2d center_px) {
  constexpr double kEyeHeightM = 100;
  View view;
  view.eye_from_level = Eigen::Vector3d(1, -1, -1).asDiagonal();
  view.eye_in_level = center + Eigen::Vector3d(0, 0, kEyeHeightM);
  view.focal_px = pixels_per_m;
  view.is_parallel = true;
  view.center_px = center_px;
  return view;
}

Canvas::Canvas(cv::Size size) : pixels_(size, CV_8UC3), depth_(size, CV_32F, cv::Scalar(kInfinitelyFar)) {
  for (int y = 0; y < size.height; ++y) {
    const int shade = 250 - 22 * y / std::max(1, size.height);
    pixels_.row(y).setTo(cv::Scalar(shade, shade - 2, shade - 4));
  }
}

void Canvas::fill(const std::array<ScreenPoint, 4>& corners, const std::array<float, 4>& brightness,
                  const cv::Vec3f& bgr) {
  if (std::ranges::any_of(corners, [](const auto& c) { return !(c.z() > kNearest); })) return;
  // The diagonal that joins the darker corners keeps creases straight.
  const int first = brightness[0] + brightness[2] < brightness[1] + brightness[3] ? 0 : 1;
  const auto at = [&](int i) { return static_cast<std::size_t>((first + i) & 3); };
  triangle({corners[at(0)], corners[at(1)], corners[at(2)]},
           {brightness[at(0)], brightness[at(1)], brightness[at(2)]}, bgr);
  triangle({corners[at(0)], corners[at(2)], corners[at(3)]},
           {brightness[at(0)], brightness[at(2)], brightness[at(3)]}, bgr);
}

void Canvas::triangle(const std::array<ScreenPoint, 3>& p, const std::array<float, 3>& brightness,
                      const cv::Vec3f& bgr) {
  const float area = cross(p[0], p[1], p[2].x(), p[2].y());
  if (std::abs(area) < 1e-6F) return;
  const auto [left, right] = std::minmax({p[0].x(), p[1].x(), p[2].x()});
  const auto [top, bottom] = std::minmax({p[0].y(), p[1].y(), p[2].y()});
  const int x1 = std::min(pixels_.cols - 1, static_cast<int>(std::ceil(std::min(right, 1e6F))));
  const int y1 = std::min(pixels_.rows - 1, static_cast<int>(std::ceil(std::min(bottom, 1e6F))));
  for (int y = std::max(0, static_cast<int>(std::floor(std::max(top, -1.0F)))); y <= y1; ++y)
    for (int x = std::max(0, static_cast<int>(std::floor(std::max(left, -1.0F)))); x <= x1; ++x) {
      const auto px = static_cast<float>(x);
      const auto py = static_cast<float>(y);
      const float a = cross(p[1], p[2], px, py) / area;
      const float b = cross(p[2], p[0], px, py) / area;
      const float c = 1 - a - b;
      if (a < 0 || b < 0 || c < 0) continue;
      const float z = a * p[0].z() + b * p[1].z() + c * p[2].z();
      float& nearest = depth_.at<float>(y, x);
      if (z >= nearest) continue;
      nearest = z;
      const float light = a * brightness[0] + b * brightness[1] + c * brightness[2];
      auto& pixel = pixels_.at<cv::Vec3b>(y, x);
      for (int channel = 0; channel < 3; ++channel)
        pixel[channel] = cv::saturate_cast<std::uint8_t>(bgr[channel] * light);
    }
}

void Canvas::line(const ScreenPoint& from, const ScreenPoint& to, const cv::Vec3f& bgr, int thickness_px,
                  float alpha, float hidden_alpha) {
  if (!(from.z() > kNearest) || !(to.z() > kNearest)) return;
  if (!(from.head<2>().cwiseAbs().maxCoeff() < kFarOutside &&
        to.head<2>().cwiseAbs().maxCoeff() < kFarOutside))
    return;
  const float length = (to - from).head<2>().norm();
  const int steps = static_cast<int>(std::min(length, 20000.0F)) + 1;
  const int reach = thickness_px / 2;
  const cv::Rect all(0, 0, pixels_.cols, pixels_.rows);
  cv::Point last(-1, -1);
  for (int i = 0; i <= steps; ++i) {
    const ScreenPoint p = from + (to - from) * (static_cast<float>(i) / static_cast<float>(steps));
    const cv::Point center(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y())));
    if (center == last) continue;
    last = center;
    for (int dy = -reach; dy <= reach; ++dy)
      for (int dx = -reach; dx <= reach; ++dx) {
        const cv::Point at = center + cv::Point(dx, dy);
        if (!all.contains(at) || dx * dx + dy * dy > reach * reach + 1) continue;
        const bool hidden = p.z() > depth_.at<float>(at) + kDepthBias;
        pixels_.at<cv::Vec3b>(at) = blend(pixels_.at<cv::Vec3b>(at), bgr, hidden ? hidden_alpha : alpha);
      }
  }
}

void Canvas::outline(float strength) {
  constexpr float kJumpM = 0.12F;
  const cv::Mat before = pixels_.clone();
  for (int y = 1; y + 1 < depth_.rows; ++y)
    for (int x = 1; x + 1 < depth_.cols; ++x) {
      const float z = depth_.at<float>(y, x);
      const float farthest = std::max({depth_.at<float>(y, x - 1), depth_.at<float>(y, x + 1),
                                       depth_.at<float>(y - 1, x), depth_.at<float>(y + 1, x)});
      if (farthest - z > kJumpM)
        pixels_.at<cv::Vec3b>(y, x) = blend(before.at<cv::Vec3b>(y, x), cv::Vec3f(40, 35, 30), strength);
    }
}

}  // namespace rds::tools
