// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/config_reader.hpp"
#include "services/tracker/core/calibration/self_calibration_config.hpp"
#include "services/tracker/core/features/extraction_config.hpp"
#include "services/tracker/core/map/map_config.hpp"
#include "services/tracker/core/mapping/mapping_config.hpp"
#include "services/tracker/core/pose/pose_config.hpp"
#include "services/tracker/core/relocalization/relocalization_config.hpp"
#include "services/tracker/core/removal/removal_config.hpp"

namespace rds::tracker {

/// States of tracking.
struct QualityConfig {
  int min_features_to_start = 150;  // with depth, for the first keyframe
  int min_inliers = 30;             // below: weak
  int min_inliers_weak = 15;        // below: lost
  double min_found_share = 0.25;    // of the usual share of expected points found; below: weak
  double weak_s = 1.0;              // of weak tracking in a row, then lost
  double by_depth_s = 0.5;          // of tracking by depth alone, then lost
  double young_map_s = 5.0;         // of tracking; a younger map is given up by who is lost in it for as long
  bool operator==(const QualityConfig&) const = default;
};

struct TrackerConfig {
  ExtractionConfig extraction;
  DepthConfig depth;
  SelfCalibrationConfig self_calibration;
  PoseOptimizationConfig pose;
  FollowingConfig following;
  RemovalConfig removal;
  MatchingConfig matching;
  KeyframeConfig keyframe;
  MapConfig map;
  LocalMappingConfig local_mapping;
  RelocalizationConfig relocalization;
  QualityConfig quality;
  bool localize_only = false;  // in the map that it starts from, which stays as it is
  bool operator==(const TrackerConfig&) const = default;
};

/// Reads section by section; an absent key keeps its default.
void read(config::ConfigReader& reader, TrackerConfig& config);

}  // namespace rds::tracker
