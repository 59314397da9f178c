// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/config_reader.hpp"
#include "common/vision/descriptor_matching.hpp"
#include "common/vision/place_index.hpp"

namespace rds::loop_closer {

/// Which earlier keyframes are looked at.
struct CandidateConfig {
  int min_gap_keyframes = 10;        // between the keyframe and the candidate
  double min_score = 0.02;           // of the place index; another room reaches .02
  int max_candidates = 2;            // verified per keyframe
  int min_separation_keyframes = 5;  // between two candidates, so that they are different views

  bool operator==(const CandidateConfig&) const = default;
};

/// What a rigid transform between two keyframes has to explain.
struct VerificationConfig {
  double max_depth_m = 6.0;
  int ransac_iterations = 500;
  double max_ray_error = 0.008;           // in x/z and y/z; 4 px at f = 525 px
  double max_inverse_depth_error = 0.05;  // [1/m]; 5 cm at 1 m, 20 cm at 2 m
  int min_ransac_inliers = 20;
  int min_inliers = 50;
  double search_radius = 0.02;    // in x/z and y/z, for matches guided by the transform
  double min_inlier_share = 0.2;  // of the features that both keyframes should see
  double min_extent_m = 0.15;     // second largest standard deviation of the matched points

  bool operator==(const VerificationConfig&) const = default;
};

/// When verified detections become a loop.
struct ConsistencyConfig {
  int min_detections = 3;    // that agree on the correction, …
  int window_keyframes = 6;  // among so many newest keyframes
  double max_difference_m = 0.10;
  double max_difference_rad = 0.05;
  double min_correction_m = 0.05;  // below both, the loop is already closed and nothing is done
  double min_correction_rad = 0.035;
  double max_drift_share = 0.3;    // largest believable drift per travelled metre …
  double max_drift_floor_m = 0.3;  // … beyond this
  double max_drift_rad = 0.8;

  bool operator==(const ConsistencyConfig&) const = default;
};

struct PoseGraphConfig {
  int max_iterations = 50;
  int max_covisible_edges = 5;    // per keyframe
  int min_covisible_weight = 50;  // shared map points
  double edge_sigma_m = 0.01;
  double edge_sigma_rad = 0.005;
  double loop_sigma_m = 0.01;
  double loop_sigma_rad = 0.005;
  double max_loop_residual_m = 0.10;  // a loop edge that stays worse after optimisation was wrong
  double max_loop_residual_rad = 0.05;

  bool operator==(const PoseGraphConfig&) const = default;
};

struct LoopCloserConfig {
  vision::PlaceIndexConfig place_index;
  CandidateConfig candidates;
  vision::DescriptorMatchConfig matching{.max_distance = 64, .max_ratio = 0.85};
  VerificationConfig verification;
  ConsistencyConfig consistency;
  PoseGraphConfig pose_graph;
  int max_features = 1500;  // kept per keyframe

  bool operator==(const LoopCloserConfig&) const = default;
};

void read(config::ConfigReader& reader, LoopCloserConfig& config);

}  // namespace rds::loop_closer
