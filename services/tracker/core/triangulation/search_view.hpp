// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "services/tracker/core/features/feature_set.hpp"
#include "services/tracker/core/map/map_point.hpp"
#include "services/tracker/core/motion/rolling_shutter.hpp"
#include "services/tracker/core/triangulation/triangulation.hpp"

namespace rds::tracker {

/// A feature that sees no point yet.
struct FreeFeature {
  std::uint32_t index;
  Eigen::Vector3d ray;  // z = 1; where the middle row would see what is far away
};

/// A keyframe that is searched for features that see the same, where bundle adjustment has put it. The
/// features outlive it.
struct SearchView {
  const FeatureSet& features;
  ShutterMotion motion;  // that the features are compensated for
  double readout_s;      // of the camera, as far as known by now
  ObservationModel model;
  geometry::Pose camera_from_map;
  Eigen::Vector3d camera_in_map;
  std::vector<PointId> taken;           // per feature: kNoId if it may see a new point
  std::vector<FreeFeature> free = {};  // once they are listed

  void list_free();
  [[nodiscard]] const Feature& feature(std::uint32_t i) const { return features[i]; }
  /// From where the feature's row was read.
  [[nodiscard]] PointView see(std::uint32_t i, const ScalePyramid& pyramid) const;

 private:
  [[nodiscard]] Twist moved(std::uint32_t i) const;
  [[nodiscard]] Eigen::Vector3d ray(std::uint32_t i) const;
};

}  // namespace rds::tracker
