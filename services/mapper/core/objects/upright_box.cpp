// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/objects/upright_box.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace rds::mapper {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kTrim = 0.02;  // of the points on either side, as of a trimmed_box()
constexpr int kCoarseDegrees = 5;
constexpr std::size_t kMostSearched = 500;  // points while the angle is searched
constexpr double kClearlyLess = 0.99;       // of the area: by less a turn is not worth it

struct Interval {
  double low = 0;
  double high = 0;
  [[nodiscard]] double length() const { return high - low; }
  [[nodiscard]] double middle() const { return (low + high) / 2; }
};

/// Of the points along a direction, without their outliers.
Interval extent(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& direction,
                std::vector<double>& values) {
  values.resize(points.size());
  std::ranges::transform(points, values.begin(), [&](const auto& p) { return direction.dot(p); });
  const auto cut = static_cast<std::ptrdiff_t>(kTrim * static_cast<double>(values.size()));
  const auto low = values.begin() + cut;
  const auto high = values.end() - 1 - cut;
  std::nth_element(values.begin(), low, values.end());
  const double lowest = *low;
  std::nth_element(low, high, values.end());
  return {lowest, *high};
}

Eigen::Vector3d direction_at(double angle_rad, const Eigen::Matrix3d& map_from_level) {
  return map_from_level * Eigen::Vector3d(std::cos(angle_rad), std::sin(angle_rad), 0);
}

/// Angle of one of the edges of the least rectangle, −45° … 45°.
double angle_of_least(std::span<const Eigen::Vector3d> points, const Eigen::Matrix3d& map_from_level,
                      double thinnest_m) {
  std::vector<Eigen::Vector3d> some;
  for (std::size_t i = 0; i < points.size(); i += points.size() / kMostSearched + 1)
    some.push_back(points[i]);
  std::vector<double> values;
  const auto area = [&](int degrees) {
    const double across =
        extent(some, direction_at(degrees * kDegree, map_from_level), values).length() + thinnest_m;
    return across * (extent(some, direction_at((degrees + 90) * kDegree, map_from_level), values).length() +
                     thinnest_m);
  };
  int best = 0;
  double least = area(0);
  const auto look = [&](int degrees, double clearly) {
    const double found = area(degrees);
    if (found >= clearly * least) return;
    least = found;
    best = degrees;
  };
  for (int turn = kCoarseDegrees; turn <= 45; turn += kCoarseDegrees)
    for (const int degrees : {turn, -turn}) look(degrees, kClearlyLess);
  const int coarse = best;
  for (int turn = 1; turn < kCoarseDegrees; ++turn)
    for (const int degrees : {coarse + turn, coarse - turn}) look(degrees, 1);
  return best * kDegree;
}

}  // namespace

UprightBox upright_box(std::span<const Eigen::Vector3d> points, const Eigen::Matrix3d& map_from_level,
                       double thinnest_m) {
  std::vector<double> values;
  double yaw = angle_of_least(points, map_from_level, thinnest_m);
  Interval along = extent(points, direction_at(yaw, map_from_level), values);
  Interval across = extent(points, direction_at(yaw + std::numbers::pi / 2, map_from_level), values);
  if (across.length() > along.length()) {
    yaw += yaw > 0 ? -std::numbers::pi / 2 : std::numbers::pi / 2;
    along = extent(points, direction_at(yaw, map_from_level), values);
    across = extent(points, direction_at(yaw + std::numbers::pi / 2, map_from_level), values);
  }
  const Interval height = extent(points, map_from_level.col(2), values);
  UprightBox upright;
  upright.yaw_rad = yaw;
  geometry::OrientedBox& box = upright.box;
  box.map_from_box.linear() =
      map_from_level * Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  box.map_from_box.translation() =
      box.map_from_box.linear() * Eigen::Vector3d(along.middle(), across.middle(), height.middle());
  box.size = Eigen::Vector3d(along.length(), across.length(), height.length()).cwiseMax(thinnest_m);
  return upright;
}

}  // namespace rds::mapper
