// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/config_reader.hpp"
#include "services/tracker/core/removal/removal_config.hpp"

namespace rds::tracker {

/// ORB extraction.
struct ExtractionConfig {
  int features = 1000;         // wanted per picture
  int levels = 8;              // of the pyramid
  double scale_factor = 1.2;   // between levels
  int fast_threshold = 20;     // grey levels
  int fast_threshold_low = 7;  // where a cell shows no corner with the first
  int cell_px = 30;            // side of such a cell
  double starved_share =
      0.3;  // with fewer static features than this share of the wanted, movable ones may match
  bool operator==(const ExtractionConfig&) const = default;
};

/// Depth measurements. Their disparity fx·virtual_baseline_m / depth is what is compared with the map.
struct DepthConfig {
  double max_depth_m = 8.0;            // beyond: as if not measured
  double close_depth_m = 3.2;          // points nearer than this are made into map points at once
  double virtual_baseline_m = 0.0775;  // of the virtual stereo pair; Kinect's true one is about this
  double disparity_sigma_px = 0.6;     // of one depth measurement, whatever the pyramid level
  bool operator==(const DepthConfig&) const = default;
};

/// What is learned about the camera while it runs.
struct SelfCalibrationConfig {
  bool readout = true;            // how long reading a picture takes; false: readout_s is true
  double readout_s = 0;           // from the first row to the last (rolling shutter), to start with
  double readout_sigma_s = 0.02;  // its standard deviation
  double tolerated_readout_error_s = 0.001;  // nearer to readout_s than this nothing is changed
  bool focal_length = true;                  // false: the given one is true
  double focal_sigma = 0.05;                 // standard deviation of the given one, as a share of it
  double tolerated_focal_error =
      0.01;             // share; nearer to the given focal length than this nothing is changed
  double memory = 0.9;  // share of what was known that still counts after the next keyframe
  bool operator==(const SelfCalibrationConfig&) const = default;
};

/// Motion-only optimisation of the camera pose.
struct PoseOptimizationConfig {
  int rounds = 4;          // each ends with a new classification into inliers and outliers
  int iterations = 10;     // per round, at most
  double chi2_2d = 5.991;  // 95 % for a pixel
  double chi2_3d = 7.815;  // 95 % for a pixel with disparity
  bool operator==(const PoseOptimizationConfig&) const = default;
};

/// Following map points from picture to picture by how they look.
struct FollowingConfig {
  bool enabled = true;            // false: features are extracted and matched in every frame
  int points = 400;               // followed
  int min_points = 50;            // that must agree on a pose; with fewer, features are extracted and matched
  double min_inlier_share = 0.5;  // of the followed points, that must agree
  double min_correlation = 0.8;   // of a point's patches
  double max_shift_px = 3;        // between expected and found place, in pixels of the patch
  int coarsest_level = 4;         // of the halvings of the picture, where its motion is looked for first
  int finest_level = 2;           // … and last; points are then found one by one
  int iterations = 10;            // per level, at most
  bool operator==(const FollowingConfig&) const = default;
};

/// Data association.
struct MatchingConfig {
  int max_distance_frame = 100;   // bits, frame to frame and local map
  int max_distance_strict = 50;   // bits, by appearance only and for fusion
  double ratio = 0.8;             // best to second best of one level
  double motion_window_px = 15;   // around where the motion model expects a feature, at level 0
  double map_window_factor = 3;   // of the local map's window (2.5 px in line of sight, else 4 px)
  double lost_window_factor = 6;  // the same after a weak prediction
  bool operator==(const MatchingConfig&) const = default;
};

/// When a tracked frame becomes a keyframe.
struct KeyframeConfig {
  double reference_ratio = 0.75;  // fewer inliers than this share of the reference keyframe's points
  int min_close_tracked = 100;    // fewer close points tracked than this …
  int min_close_new = 70;         // … while more than this could be made
  int scarce_inliers = 200;       // with fewer, while movable objects are there, the map takes every keyframe
  double max_rotation_rad = 0.26;   // view change since the last keyframe
  double max_translation_m = 0.15;  // the same, for a scene 2 m away
  double known_after_s = 5;         // a view that a keyframe has for so long needs no other
  double min_interval_s = 0.09;     // between keyframes, unless tracking is about to fail
  double movable_interval_s = 0.1;  // longest, while movable objects are there or the picture changes; but
  int movable_interval_frames = 3;  // … not less than so many frames
  double static_interval_s = 1.0;   // longest, otherwise
  double changed_share = 0.35;      // drop of the share of expected points found that counts as a change
  bool operator==(const KeyframeConfig&) const = default;
};

/// Life of map points and keyframes.
struct MapConfig {
  int min_new_points = 100;       // nearest points made from a keyframe even if not close
  double min_found_ratio = 0.25;  // a map point found more rarely where it should be seen goes
  int min_observers = 2;          // keyframes that must see a point two keyframes on
  double redundant_share = 0.9;   // a keyframe goes when this share of its close points …
  int redundant_observers = 3;    // … is seen in so many others
  int min_covisible_weight = 15;  // shared points that make a covisibility edge
  int local_keyframes = 24;       // of the local map
  int max_local_points = 4000;    // of the local map
  // Keyframes of which only the pose is kept: those of this time, and so many more per reference keyframe.
  double pose_only_s = 60;  // 0: all
  int pose_only_kept = 20;
  bool operator==(const MapConfig&) const = default;
};

/// Local mapping: fusion of map points and local bundle adjustment.
struct LocalMappingConfig {
  int free_keyframes = 15;      // moved by bundle adjustment, the new one included
  int fixed_keyframes = 12;     // also see the points and hold them
  int max_points = 1600;        // of one job, most observed first
  int iterations = 4;           // of each of the two passes
  double fusion_window_px = 3;  // around the projection, at level 0
  bool operator==(const LocalMappingConfig&) const = default;
};

/// Recovery of a lost camera.
struct RelocalizationConfig {
  int candidates = 4;    // keyframes tried per frame
  int min_matches = 15;  // by appearance
  int min_inliers = 50;  // after widening the search
  int ransac_iterations = 200;
  bool operator==(const RelocalizationConfig&) const = default;
};

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
