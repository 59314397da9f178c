// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "services/tracker/core/calibration/self_calibration.hpp"
#include "services/tracker/core/config/tracker_config.hpp"
#include "services/tracker/core/map/slam_map.hpp"

namespace rds::tracker {

struct MappingKeyframe {
  KeyframeId id = kNoId;
  Pose map_from_camera = Pose::Identity();
  std::shared_ptr<const FeatureSet> features;
  std::vector<PointId> points;  // per feature; kNoId
  std::vector<bool> movable;    // per feature
  ShutterMotion motion;         // that px and depth of the features are compensated for
  double given_fx = 0;          // px, of the camera before calibration; 0: it is not calibrated
  bool fixed = false;           // holds the points, is not moved
};

/// The part of the map around a keyframe, by value: nothing in it refers to the map.
struct LocalMappingJob {
  KeyframeId keyframe = kNoId;             // the centre
  KeyframeId next_keyframe = kNoId;        // those from here on are made after the snapshot
  PointId next_point = kNoId;              // likewise
  std::uint64_t revision = 0;              // of the map's geometry
  std::vector<MappingKeyframe> keyframes;  // by ascending id
  std::vector<MapPoint> points;            // by ascending id
  double readout_s = 0;                    // of the camera, as far as known
  double focal_scale = 1;                  // the same, on the focal length it was given with
  double given_fx = 0;                     // px, of the camera that these two are about
  ScalePyramid pyramid{1, 1};
  bool triangulates = false;  // points of features without depth are made
};

/// What local mapping found out.
struct LocalMappingResult {
  struct MovedKeyframe {
    KeyframeId id;
    Pose map_from_camera;
  };
  struct MovedPoint {
    PointId id;
    Eigen::Vector3d position;
  };
  struct PointInKeyframe {
    PointId point;
    KeyframeId keyframe;
    std::uint32_t feature;
  };
  struct Fusion {
    PointId keep;
    PointId drop;
  };
  struct FeatureOfKeyframe {
    KeyframeId keyframe;
    std::uint32_t feature;
  };
  struct MadePoint {
    Eigen::Vector3d position;
    std::vector<FeatureOfKeyframe> seen;
  };

  KeyframeId keyframe = kNoId;
  KeyframeId next_keyframe = kNoId;
  PointId next_point = kNoId;
  std::uint64_t revision = 0;
  ImagingEstimate imaging;
  std::vector<MovedKeyframe> keyframes;
  std::vector<MovedPoint> points;
  std::vector<PointInKeyframe> added;
  std::vector<Fusion> fused;
  std::vector<PointInKeyframe> removed;
  std::vector<MadePoint> made;  // by triangulation
};

/// Iterations of each of the two passes of bundle adjustment. The map is adjusted again with every keyframe.
inline constexpr int kBundleIterations = 4;

/// Finds more observations of the points, fuses points that are one, adjusts keyframes and points, and makes
/// points of features without depth where several keyframes see them.
///
/// Pure, single-threaded, deterministic: a fixed number of iterations, never a time limit.
/// Source: Mur-Artal et al. 2015, §VI; Mur-Artal & Tardós 2017, §III-C (local bundle adjustment).
LocalMappingResult run_local_mapping(const LocalMappingJob& job, int iterations = kBundleIterations);

}  // namespace rds::tracker
