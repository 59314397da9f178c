// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

namespace rds::tools {

/// A point on the canvas: x, y [px], z = distance from the eye [m].
using ScreenPoint = Eigen::Vector3f;

/// How map points become screen points: level frame (z up) → eye → pixels.
struct View {
  Eigen::Matrix3d eye_from_level = Eigen::Matrix3d::Identity();  // eye: x right, y down, z forward
  Eigen::Vector3d eye_in_level = Eigen::Vector3d::Zero();
  double focal_px = 1000;  // perspective: focal length; parallel: pixels per metre
  bool is_parallel = false;
  cv::Point2d center_px;

  [[nodiscard]] ScreenPoint project(const Eigen::Vector3d& point_in_level) const;
};

/// Eye at a point, looking at another, z of the level frame upwards in the picture.
View look_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& target, double focal_px,
             cv::Point2d center_px);
/// Straight down; y of the level frame upwards in the picture.
View look_down(const Eigen::Vector3d& center, double pixels_per_m, cv::Point2d center_px);

/// A picture with a depth buffer.
class Canvas {
 public:
  explicit Canvas(cv::Size size);

  /// Quad in order around its rim; brightness per corner is interpolated. Corners nearer than 5 cm: not
  /// drawn.
  void fill(const std::array<ScreenPoint, 4>& corners, const std::array<float, 4>& brightness,
            const cv::Vec3f& bgr);

  /// Line of `thickness_px`; where surfaces hide it, it shines through with `hidden_alpha`.
  void line(const ScreenPoint& from, const ScreenPoint& to, const cv::Vec3f& bgr, int thickness_px,
            float alpha, float hidden_alpha);

  cv::Mat& pixels() { return pixels_; }
  /// Darkens pixels beside a jump in depth, so that shapes stand out.
  void outline(float strength);

 private:
  void triangle(const std::array<ScreenPoint, 3>& p, const std::array<float, 3>& brightness,
                const cv::Vec3f& bgr);

  cv::Mat pixels_;  // CV_8UC3
  cv::Mat depth_;   // CV_32F
};

}  // namespace rds::tools
