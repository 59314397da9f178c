// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "common/dynamic_segmentation/depth_grid.hpp"
#include "common/dynamic_segmentation/object_region.hpp"
#include "tests/unit/services/tracker/core/synthetic_scene.hpp"

namespace rds::tracker::test {

/// A wall 3 m away, a floor 1 m below the camera, and, if asked for, somebody: a column of 0.5 m standing at
/// x, z.
struct Somebody {
  double x_m = 0;
  double z_m = 0;  // 0: nobody
};

inline constexpr double kWall_m = 3;
inline constexpr double kFloor_m = 1;

inline image::RgbdFrame room(const Somebody& somebody = {}, std::int64_t stamp_ns = 0) {
  image::RgbdFrame frame = picture_of_wall(Pose::Identity(), stamp_ns);
  frame.depth.values = cv::Mat(frame.camera.height, frame.camera.width, CV_32FC1);
  frame.depth.metres_per_unit = 1;
  for (int y = 0; y < frame.camera.height; ++y)
    for (int x = 0; x < frame.camera.width; ++x) {
      const Eigen::Vector3d ray = frame.camera.ray({static_cast<double>(x), static_cast<double>(y)});
      double z = ray.y() > 0 ? std::min(kWall_m, kFloor_m / ray.y()) : kWall_m;
      const double aside = ray.x() * somebody.z_m - somebody.x_m;
      if (somebody.z_m > 0 && std::abs(aside) < 0.25 && ray.y() * somebody.z_m > -0.6)
        z = std::min(z, somebody.z_m - std::sqrt(0.0625 - aside * aside));
      frame.depth.values.at<float>(y, x) = static_cast<float>(z);
    }
  return frame;
}

/// Where somebody shows.
inline bool shows(const image::RgbdFrame& with, int x, int y) {
  static const image::RgbdFrame empty = room();
  return with.depth.at(x, y) < empty.depth.at(x, y) - 0.05F;
}

/// Shares of somebody's pixels and of all others that are marked.
struct Marked {
  double of_somebody = 0;
  double of_the_rest = 0;
};

inline Marked compare(const MovableMask& mask, const image::RgbdFrame& with) {
  std::array<double, 2> all{};
  std::array<double, 2> marked{};
  for (int y = 0; y < with.camera.height; ++y)
    for (int x = 0; x < with.camera.width; ++x) {
      const std::size_t which = shows(with, x, y) ? 0 : 1;
      ++all[which];
      marked[which] += mask.covers({x, y}) ? 1 : 0;
    }
  return {marked[0] / std::max(1.0, all[0]), marked[1] / std::max(1.0, all[1])};
}

/// The region that a predicted box of somebody gives, larger by a margin on each side.
inline segmentation::ObjectRegion region_of(const Somebody& somebody, double margin_px = 0) {
  const geometry::CameraModel camera = small_camera();
  const auto px = [&](double x, double y) { return camera.project({x, y, somebody.z_m}); };
  const Eigen::Vector2d low = px(somebody.x_m - 0.3, -0.6);
  const Eigen::Vector2d high = px(somebody.x_m + 0.3, kFloor_m);
  return {{low.x() - margin_px, low.y() - margin_px, high.x() + margin_px, high.y() + margin_px},
          static_cast<float>(somebody.z_m - 0.4),
          static_cast<float>(somebody.z_m + 0.4)};
}

}  // namespace rds::tracker::test
