// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/config/config_reader.hpp"
#include "common/labels/table.hpp"

namespace rds::tracker::prediction {

/// The paper's Algorithm 1.
struct PlaneSortConfig {
  double min_iou = 0.3;           // SORT's, in each coordinate plane
  double max_age_s = 1.0;         // a track without a match is forgotten
  double units_per_metre = 200;   // scale of the planes: SORT's noise is published in pixels
  double frames_per_second = 30;  // ... and per frame of videos

  bool operator==(const PlaneSortConfig&) const = default;
};

/// One constant-velocity filter per object in 3-D. "Vertical" is along the picture's y axis.
struct Kalman3dConfig {
  double acceleration = 1.5;      // [m/s²/√Hz], process noise: people start, stop and turn
  double initial_speed = 1.2;     // [m/s], standard deviation before motion has been seen
  double vertical_share = 0.3;    // of both: objects move along the ground
  double lateral_noise_m = 0.08;  // of a detected centre, across the viewing direction
  double vertical_noise_m = 0.15;
  double depth_noise_m = 0.15;  // along it
  double size_noise_m = 0.06;   // of a detected width or height
  double size_drift = 0.5;      // [m/√s], how fast sizes wander (people turn, arms move)
  double min_width_m = 0.5;     // an object cut off by the picture's side is at least this wide
  double max_distance_m = 0.6;  // an observation further from the prediction starts a new object,
  double gate_sigma = 3.5;      // ... and so does one that is more improbable
  int max_misses = 2;           // key frames that should have shown an object, then it is forgotten
  double max_age_s = 1.5;       // ... and so is one that has not been seen for longer
  double growth_sigma = 0.3;    // standard deviations of the centre that the box grows per side
  double max_growth_m = 0.2;    // ... at most

  bool operator==(const Kalman3dConfig&) const = default;
};

/// From the predicted box to the features that are dropped.
struct RegionConfig {
  double margin_px = 4;         // added to each side of the region's box
  double margin_depth_m = 0.1;  // added to each end of the depth interval

  bool operator==(const RegionConfig&) const = default;
};

struct PredictionConfig {
  std::string algorithm = "kalman3d";  // or "paper"
  labels::Table labels;            // which of them are movable
  double min_score = 0.35;         // detections with less are ignored
  double duplicate_overlap = 0.7;  // share of the smaller box: two boxes of one object
  double doubtful_share = 0.9;     // a box of more of the picture than this …
  double doubtful_score = 0.6;     // … with less than this is ignored
  double reach_share = 0.08;  // of its width and height, by which a movable object is shown larger per side
  double border_px = 6;       // a box that ends this near to the picture's edge is cut off by it
  PlaneSortConfig paper;
  Kalman3dConfig kalman3d;
  RegionConfig region;

  bool operator==(const PredictionConfig&) const = default;
};

void read(config::ConfigReader& reader, PredictionConfig& config);

bool is_movable(const PredictionConfig& config, std::string_view label);

}  // namespace rds::tracker::prediction
