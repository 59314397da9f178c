// SPDX-License-Identifier: Apache-2.0
#include "common/image/depth_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <type_traits>

namespace rds::image {
namespace {

constexpr int kSquarePx = 16;      // a lens bends rays by next to nothing within it
constexpr int kParts = 2;          // of the rows, at the same time
constexpr double kNearM = 1;       // where something near is, for what a picture moves by
constexpr double kUnmovedPx = 0.5;
constexpr double kNearestRayZ = 0.1;

int squares(int pixels) { return (pixels + kSquarePx - 1) / kSquarePx; }

using Floats = Eigen::Array<float, 1, Eigen::Dynamic>;
using Indices = Eigen::Array<int, 1, Eigen::Dynamic>;

/// Where the rays of one row of pixels show after the turn, and by what depth along them is more then.
struct TurnedRow {
  explicit TurnedRow(Eigen::Index pixels) : x(pixels), y(pixels), scale(pixels) {}

  /// Linear between the corners of the squares. @param corners  x, y, scale.
  void set(const cv::Mat4f& corners, int row) {
    static const Eigen::Array<float, 1, kSquarePx> ramp =
        Eigen::Array<float, 1, kSquarePx>::LinSpaced(0, 1 - 1.0F / kSquarePx);
    const float down = static_cast<float>(row % kSquarePx) / kSquarePx;
    const auto corner = [&](int column) -> cv::Vec4f {
      const cv::Vec4f& above = corners(row / kSquarePx, column);
      return above + down * (corners(row / kSquarePx + 1, column) - above);
    };
    cv::Vec4f left = corner(0);
    for (int square = 0; square + 1 < corners.cols; ++square) {
      const cv::Vec4f right = corner(square + 1);
      const Eigen::Index first = square * kSquarePx;
      const Eigen::Index n = std::min<Eigen::Index>(kSquarePx, x.size() - first);
      x.segment(first, n) = left[0] + (right[0] - left[0]) * ramp.head(n);
      y.segment(first, n) = left[1] + (right[1] - left[1]) * ramp.head(n);
      scale.segment(first, n) = left[2] + (right[2] - left[2]) * ramp.head(n);
      left = right;
    }
  }

  Floats x, y, scale;
};

/// Depths [m] of the picture at these places; 0 outside, and where nothing is measured.
template <class Value>
void look_up(const DepthImage& picture, const Floats& x, const Floats& y, Indices& at, Floats& depth_m) {
  const cv::Mat& values = picture.values;
  const auto columns = static_cast<float>(values.cols);
  const auto rows = static_cast<float>(values.rows);
  const auto length = static_cast<int>(values.step1());
  at = ((x > -0.5F) && (y > -0.5F) && (x + 0.5F < columns) && (y + 0.5F < rows))
           .select((y + 0.5F).cast<int>() * length + (x + 0.5F).cast<int>(), -1);
  const Value* first = values.ptr<Value>();
  for (Eigen::Index i = 0; i < at.size(); ++i)
    depth_m[i] = at[i] >= 0 && first[at[i]] > 0 ? static_cast<float>(first[at[i]]) : 0;
  depth_m *= picture.metres_per_unit;
}

/// @param corners  of the squares, after the turn: column, row, scale of depth. @param rows  of `result`.
template <class Value>
void move_rows(const DepthImage& picture, const cv::Mat4f& corners, const Eigen::Vector3f& shift_m,
               const geometry::CameraModel& camera, const cv::Range& rows, cv::Mat& result) {
  constexpr float kRounding = std::is_integral_v<Value> ? 0.5F : 0.0F;
  constexpr float kMost = std::is_integral_v<Value> ? std::numeric_limits<Value>::max() : 1e6F;
  const Eigen::Array2f focal(static_cast<float>(camera.fx), static_cast<float>(camera.fy));
  const Eigen::Array2f centre(static_cast<float>(camera.cx), static_cast<float>(camera.cy));
  const Eigen::Array2f along = shift_m.head<2>().array() * focal;
  TurnedRow row(result.cols);
  Indices at(result.cols);
  Floats turned_m(result.cols), per_m(result.cols), found_m(result.cols);
  for (int y = rows.start; y < rows.end; ++y) {
    row.set(corners, y);
    look_up<Value>(picture, row.x, row.y, at, turned_m);
    per_m = (turned_m > 0).select(1 / turned_m, 0.0F);
    row.x += (along.x() - (row.x - centre.x()) * shift_m.z()) * per_m;
    row.y += (along.y() - (row.y - centre.y()) * shift_m.z()) * per_m;
    look_up<Value>(picture, row.x, row.y, at, found_m);
    found_m = (found_m > 0 && turned_m > 0).select((found_m - shift_m.z()) / row.scale, 0.0F);
    found_m = (found_m / picture.metres_per_unit + kRounding).max(0.0F).min(kMost);
    Eigen::Map<Eigen::Array<Value, 1, Eigen::Dynamic>>(result.ptr<Value>(y), result.cols) =
        found_m.cast<Value>();
  }
}

}  // namespace

DepthMotion::DepthMotion(const geometry::CameraModel& camera)
    : camera_(camera), rays_(squares(camera.height) + 1, squares(camera.width) + 1) {
  for (int r = 0; r < rays_.rows; ++r)
    for (int c = 0; c < rays_.cols; ++c) {
      const Eigen::Vector2d corner(c * kSquarePx, r * kSquarePx);
      const Eigen::Vector3f ray = camera.ray(corner).cast<float>();
      rays_(r, c) = {ray.x(), ray.y(), ray.z()};
    }
}

/// Column, row and scale of depth of the squares' corners after the turn.
cv::Mat4f DepthMotion::turned(const geometry::Pose& taken_from_here) const {
  cv::Mat4f corners(rays_.size());
  for (int r = 0; r < rays_.rows; ++r)
    for (int c = 0; c < rays_.cols; ++c) {
      const cv::Vec3f& ray = rays_(r, c);
      Eigen::Vector3d there = taken_from_here.linear() * Eigen::Vector3d(ray[0], ray[1], ray[2]);
      there.z() = std::max(there.z(), kNearestRayZ);
      const Eigen::Vector2d px = camera_.project(there);
      corners(r, c) = {static_cast<float>(px.x()), static_cast<float>(px.y()), static_cast<float>(there.z()),
                       0};
    }
  return corners;
}

DepthImage DepthMotion::moved(const DepthImage& picture, const geometry::Pose& taken_from_here,
                              const Execute& execute) const {
  const bool is_whole = picture.values.type() == CV_16UC1;
  if (picture.values.size() != cv::Size(camera_.width, camera_.height) ||
      (!is_whole && picture.values.type() != CV_32FC1))
    throw std::invalid_argument("depth to move is not of its camera's size, or of another type");
  const double moves = geometry::rotation_angle_rad(taken_from_here.linear()) +
                       taken_from_here.translation().norm() / kNearM;
  if (!(moves * std::max(camera_.fx, camera_.fy) > kUnmovedPx)) return picture;
  const cv::Mat4f corners = turned(taken_from_here);
  const Eigen::Vector3f shift_m = taken_from_here.translation().cast<float>();
  DepthImage result{.values = cv::Mat(picture.values.size(), picture.values.type()),
                    .metres_per_unit = picture.metres_per_unit,
                    .owner = nullptr};
  execute(kParts, [&](std::size_t part) {
    const int i = static_cast<int>(part);
    const cv::Range rows(camera_.height * i / kParts, camera_.height * (i + 1) / kParts);
    const auto move = is_whole ? move_rows<std::uint16_t> : move_rows<float>;
    move(picture, corners, shift_m, camera_, rows, result.values);
  });
  return result;
}

}  // namespace rds::image
