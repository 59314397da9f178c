// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <vector>

#include <opencv2/core.hpp>

#include "services/loop_closer/core/loop_types.hpp"
#include "services/loop_closer/core/loop_verification.hpp"

namespace rds::loop_closer {

/// A world of points with descriptors; a camera sees those in front of it within its field of view.
struct SyntheticWorld {
  std::vector<Eigen::Vector3d> points;  // map frame [m]
  cv::Mat descriptors;

  /// Points on the wall of a round room, 4 m from its middle.
  static SyntheticWorld round_room(int count, std::uint64_t seed) {
    SyntheticWorld world;
    cv::RNG rng(seed);
    for (int i = 0; i < count; ++i) {
      const double angle = rng.uniform(0.0, 2 * M_PI);
      const double radius = rng.uniform(3.0, 4.5);
      world.points.emplace_back(radius * std::sin(angle), rng.uniform(-1.5, 1.5), radius * std::cos(angle));
    }
    world.descriptors.create(count, 32, CV_8U);
    rng.fill(world.descriptors, cv::RNG::UNIFORM, 0, 256);
    return world;
  }

  /// Features of a camera at `map_from_camera`, with 5 mm of noise and `flipped` of the descriptor bits
  /// changed.
  [[nodiscard]] KeyframeFeatures seen_from(const geometry::Pose& map_from_camera, std::uint64_t seed,
                                           double flipped = 0.05) const {
    KeyframeFeatures features;
    cv::RNG rng(seed + 1);
    for (std::size_t i = 0; i < points.size(); ++i) {
      Eigen::Vector3d p = map_from_camera.inverse() * points[i];
      if (p.z() < 0.5 || std::abs(p.x()) > 0.6 * p.z() || std::abs(p.y()) > 0.45 * p.z()) continue;
      for (int axis = 0; axis < 3; ++axis) p[axis] += rng.gaussian(0.005);
      features.points.push_back(p.cast<float>());
      cv::Mat descriptor = descriptors.row(static_cast<int>(i)).clone();
      for (int bit = 0; bit < 256; ++bit)
        if (rng.uniform(0.0, 1.0) < flipped)
          descriptor.at<std::uint8_t>(bit / 8) ^= static_cast<std::uint8_t>(1 << (bit % 8));
      features.descriptors.push_back(descriptor);
    }
    features.movable.assign(features.points.size(), 0);
    features.map_from_camera = map_from_camera;
    return features;
  }
};

/// Camera in a round room that looks outwards in the direction `angle_rad`, standing a little off the middle.
inline geometry::Pose looking_out(double angle_rad) {
  geometry::Pose pose = geometry::Pose::Identity();
  pose.linear() = Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
  pose.translation() = pose.linear() * Eigen::Vector3d(0, 0, 0.7);
  return pose;
}

inline KeyframeView view_of_all(const KeyframeFeatures& features) {
  KeyframeView view{features.descriptors, {}};
  for (const auto& point : features.points) view.points.push_back(point.cast<double>());
  return view;
}

}  // namespace rds::loop_closer
