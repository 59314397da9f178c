// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/tracker_service_config.hpp"

#include <gmock/gmock.h>

namespace rds::tracker {
namespace {

/// Reads the shipped file over `config`; throws what is wrong with it.
TrackerServiceConfig read_shipped(TrackerServiceConfig config) {
  auto reader = config::ConfigReader::from_file(RDS_SOURCE_DIR "/services/tracker/tracker.yaml");
  read(reader, config);
  reader.finish();
  return config;
}

TEST(TrackerServiceConfig, ShippedFileSaysTheServicesDefaults) {
  TrackerServiceConfig changed;
  // Here and below: values that differ from the defaults, so that a key missing from the file would show.
  changed.camera.color = "x";
  changed.camera.camera_info = "x";
  changed.camera.depth = "x";
  changed.camera.best_effort = true;
  changed.camera.pairing_tolerance_s = 0;
  changed.lockstep.enabled = true;
  changed.lockstep.detection_latency_frames = 9;
  changed.lockstep.mapping_latency_frames = 9;
  changed.lockstep.loop_latency_frames = 9;
  changed.lockstep.timeout_s = 9;
  changed.dynamics = false;
  changed.loop_closer = false;
  changed.map_file = "x";
  const TrackerServiceConfig shipped = read_shipped(changed);
  const TrackerServiceConfig defaults;
  EXPECT_EQ(shipped.camera.color, defaults.camera.color);
  EXPECT_EQ(shipped.camera.camera_info, defaults.camera.camera_info);
  EXPECT_EQ(shipped.camera.depth, defaults.camera.depth);
  EXPECT_EQ(shipped.camera.best_effort, defaults.camera.best_effort);
  EXPECT_EQ(shipped.camera.pairing_tolerance_s, defaults.camera.pairing_tolerance_s);
  EXPECT_EQ(shipped.lockstep.enabled, defaults.lockstep.enabled);
  EXPECT_EQ(shipped.lockstep.detection_latency_frames, defaults.lockstep.detection_latency_frames);
  EXPECT_EQ(shipped.lockstep.mapping_latency_frames, defaults.lockstep.mapping_latency_frames);
  EXPECT_EQ(shipped.lockstep.loop_latency_frames, defaults.lockstep.loop_latency_frames);
  EXPECT_EQ(shipped.lockstep.timeout_s, defaults.lockstep.timeout_s);
  EXPECT_EQ(shipped.dynamics, defaults.dynamics);
  EXPECT_EQ(shipped.loop_closer, defaults.loop_closer);
  EXPECT_EQ(shipped.map_file, defaults.map_file);
}

TEST(TrackerServiceConfig, ShippedFileSaysTheCoresDefaults) {
  TrackerServiceConfig changed;
  TrackerConfig& core = changed.tracker;
  core.extraction.features = 9;
  core.extraction.levels = 9;
  core.extraction.scale_factor = 9;
  core.extraction.fast_threshold = 9;
  core.extraction.fast_threshold_low = 9;
  core.extraction.cell_px = 9;
  core.extraction.starved_share = 9;
  core.depth.max_depth_m = 9;
  core.depth.close_depth_m = 9;
  core.depth.virtual_baseline_m = 9;
  core.depth.disparity_sigma_px = 9;
  core.pose.rounds = 9;
  core.pose.iterations = 9;
  core.pose.chi2_2d = 9;
  core.pose.chi2_3d = 9;
  core.matching.max_distance_frame = 9;
  core.matching.max_distance_strict = 9;
  core.matching.ratio = 9;
  core.matching.motion_window_px = 9;
  core.matching.map_window_factor = 9;
  core.matching.lost_window_factor = 9;
  core.keyframe.reference_ratio = 9;
  core.keyframe.min_close_tracked = 9;
  core.keyframe.min_close_new = 9;
  core.keyframe.max_rotation_rad = 9;
  core.keyframe.max_translation_m = 9;
  core.keyframe.min_interval_s = 9;
  core.keyframe.movable_interval_s = 9;
  core.keyframe.static_interval_s = 9;
  core.keyframe.changed_share = 9;
  core.map.min_new_points = 9;
  core.map.min_found_ratio = 9;
  core.map.min_observers = 9;
  core.map.redundant_share = 9;
  core.map.redundant_observers = 9;
  core.map.min_covisible_weight = 9;
  core.map.local_keyframes = 9;
  core.map.max_local_points = 9;
  core.local_mapping.free_keyframes = 9;
  core.local_mapping.fixed_keyframes = 9;
  core.local_mapping.max_points = 9;
  core.local_mapping.iterations = 9;
  core.local_mapping.fusion_window_px = 9;
  core.relocalization.candidates = 9;
  core.relocalization.min_matches = 9;
  core.relocalization.min_inliers = 9;
  core.relocalization.ransac_iterations = 9;
  core.quality.min_features_to_start = 9;
  core.quality.min_inliers = 9;
  core.quality.min_inliers_weak = 9;
  core.quality.weak_s = 9;
  core.localize_only = true;
  EXPECT_EQ(read_shipped(changed).tracker, TrackerConfig());
}

TEST(TrackerServiceConfig, ShippedFileSaysThePredictionsDefaults) {
  TrackerServiceConfig changed;
  prediction::PredictionConfig& prediction = changed.prediction;
  prediction.algorithm = "paper";
  prediction.movable_labels = {};
  prediction.min_score = .9;
  prediction.duplicate_overlap = .9;
  prediction.border_px = 9;
  prediction.paper.min_iou = .9;
  prediction.paper.max_age_s = 9;
  prediction.paper.units_per_metre = 9;
  prediction.paper.frames_per_second = 9;
  prediction.kalman3d.acceleration = 9;
  prediction.kalman3d.initial_speed = 9;
  prediction.kalman3d.vertical_share = 9;
  prediction.kalman3d.lateral_noise_m = 9;
  prediction.kalman3d.vertical_noise_m = 9;
  prediction.kalman3d.depth_noise_m = 9;
  prediction.kalman3d.size_noise_m = 9;
  prediction.kalman3d.size_drift = 9;
  prediction.kalman3d.min_width_m = 9;
  prediction.kalman3d.max_distance_m = 9;
  prediction.kalman3d.gate_sigma = 9;
  prediction.kalman3d.max_misses = 9;
  prediction.kalman3d.max_age_s = 9;
  prediction.kalman3d.growth_sigma = 9;
  prediction.kalman3d.max_growth_m = 9;
  prediction.region.margin_px = 9;
  prediction.region.margin_depth_m = 9;
  const prediction::PredictionConfig shipped = read_shipped(changed).prediction;
  const prediction::PredictionConfig defaults;
  EXPECT_EQ(shipped.algorithm, defaults.algorithm);
  EXPECT_EQ(shipped.movable_labels, defaults.movable_labels);
  EXPECT_EQ(shipped.min_score, defaults.min_score);
  EXPECT_EQ(shipped.duplicate_overlap, defaults.duplicate_overlap);
  EXPECT_EQ(shipped.border_px, defaults.border_px);
  EXPECT_EQ(shipped.paper.min_iou, defaults.paper.min_iou);
  EXPECT_EQ(shipped.paper.max_age_s, defaults.paper.max_age_s);
  EXPECT_EQ(shipped.paper.units_per_metre, defaults.paper.units_per_metre);
  EXPECT_EQ(shipped.paper.frames_per_second, defaults.paper.frames_per_second);
  EXPECT_EQ(shipped.kalman3d.acceleration, defaults.kalman3d.acceleration);
  EXPECT_EQ(shipped.kalman3d.initial_speed, defaults.kalman3d.initial_speed);
  EXPECT_EQ(shipped.kalman3d.vertical_share, defaults.kalman3d.vertical_share);
  EXPECT_EQ(shipped.kalman3d.lateral_noise_m, defaults.kalman3d.lateral_noise_m);
  EXPECT_EQ(shipped.kalman3d.vertical_noise_m, defaults.kalman3d.vertical_noise_m);
  EXPECT_EQ(shipped.kalman3d.depth_noise_m, defaults.kalman3d.depth_noise_m);
  EXPECT_EQ(shipped.kalman3d.size_noise_m, defaults.kalman3d.size_noise_m);
  EXPECT_EQ(shipped.kalman3d.size_drift, defaults.kalman3d.size_drift);
  EXPECT_EQ(shipped.kalman3d.min_width_m, defaults.kalman3d.min_width_m);
  EXPECT_EQ(shipped.kalman3d.max_distance_m, defaults.kalman3d.max_distance_m);
  EXPECT_EQ(shipped.kalman3d.gate_sigma, defaults.kalman3d.gate_sigma);
  EXPECT_EQ(shipped.kalman3d.max_misses, defaults.kalman3d.max_misses);
  EXPECT_EQ(shipped.kalman3d.max_age_s, defaults.kalman3d.max_age_s);
  EXPECT_EQ(shipped.kalman3d.growth_sigma, defaults.kalman3d.growth_sigma);
  EXPECT_EQ(shipped.kalman3d.max_growth_m, defaults.kalman3d.max_growth_m);
  EXPECT_EQ(shipped.region.margin_px, defaults.region.margin_px);
  EXPECT_EQ(shipped.region.margin_depth_m, defaults.region.margin_depth_m);
}

TEST(TrackerServiceConfig, LocalizingNeedsAMap) {
  config::ConfigReader reader(YAML::Load("localize_only: true"), "tracker.yaml");
  TrackerServiceConfig config;
  read(reader, config);
  EXPECT_THROW(reader.finish(), config::ConfigError);
}

TEST(TrackerServiceConfig, GivenPosesKnowNoSavedMap) {
  config::ConfigReader reader(YAML::Load("{poses_file: poses.txt, map_file: map.rds}"), "tracker.yaml");
  TrackerServiceConfig config;
  read(reader, config);
  EXPECT_THROW(reader.finish(), config::ConfigError);
}

TEST(TrackerServiceConfig, NamesEveryViolation) {
  config::ConfigReader reader(
      YAML::Load("{lockstep_timeout_s: 0, camera: {pairing_tolerance_s: 3, colour: x}}"), "tracker.yaml");
  TrackerServiceConfig config;
  read(reader, config);
  try {
    reader.finish();
    FAIL() << "no violation found";
  } catch (const config::ConfigError& e) {
    EXPECT_THAT(e.what(), ::testing::AllOf(::testing::HasSubstr("lockstep_timeout_s: 0, expected"),
                                           ::testing::HasSubstr("camera.pairing_tolerance_s: 3, expected"),
                                           ::testing::HasSubstr("camera.colour: unknown key")));
  }
}

}  // namespace
}  // namespace rds::tracker
