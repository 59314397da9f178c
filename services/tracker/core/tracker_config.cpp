// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/tracker_config.hpp"

namespace rds::tracker {
namespace {

void read(config::ConfigReader& r, ExtractionConfig& c) {
  r.value("features", c.features, 100, 10000);
  r.value("levels", c.levels, 1, 12);
  r.value("scale_factor", c.scale_factor, 1.05, 2.0);
  r.value("fast_threshold", c.fast_threshold, 2, 100, "grey levels");
  r.value("fast_threshold_low", c.fast_threshold_low, 2, 100, "grey levels");
  r.value("cell_px", c.cell_px, 10, 200, "px");
  r.value("starved_share", c.starved_share, 0.0, 1.0);
}

void read(config::ConfigReader& r, DepthConfig& c) {
  r.value("max_depth_m", c.max_depth_m, 0.5, 100.0, "m");
  r.value("close_depth_m", c.close_depth_m, 0.3, 100.0, "m");
  r.value("virtual_baseline_m", c.virtual_baseline_m, 0.01, 1.0, "m");
  r.value("disparity_sigma_px", c.disparity_sigma_px, 0.05, 10.0, "px");
}

void read(config::ConfigReader& r, SelfCalibrationConfig& c) {
  r.value("readout", c.readout);
  r.value("readout_s", c.readout_s, -0.05, 0.05, "s");
  r.value("readout_sigma_s", c.readout_sigma_s, 1e-4, 1.0, "s");
  r.value("tolerated_readout_error_s", c.tolerated_readout_error_s, 0.0, 0.05, "s");
  r.value("focal_length", c.focal_length);
  r.value("focal_sigma", c.focal_sigma, 1e-3, 1.0);
  r.value("tolerated_focal_error", c.tolerated_focal_error, 0.0, 0.3);
  r.value("memory", c.memory, 0.0, 1.0);
}

void read(config::ConfigReader& r, PoseOptimizationConfig& c) {
  r.value("rounds", c.rounds, 1, 10);
  r.value("iterations", c.iterations, 1, 100);
  r.value("chi2_2d", c.chi2_2d, 1.0, 50.0);
  r.value("chi2_3d", c.chi2_3d, 1.0, 50.0);
}

void read(config::ConfigReader& r, FollowingConfig& c) {
  r.value("enabled", c.enabled);
  r.value("points", c.points, 50, 5000);
  r.value("min_points", c.min_points, 10, 5000);
  r.value("min_inlier_share", c.min_inlier_share, 0.0, 1.0);
  r.value("min_correlation", c.min_correlation, 0.0, 1.0);
  r.value("max_shift_px", c.max_shift_px, 0.5, 10.0, "px");
  r.value("coarsest_level", c.coarsest_level, 0, 6);
  r.value("finest_level", c.finest_level, 0, 6);
  r.value("iterations", c.iterations, 1, 100);
}

void read(config::ConfigReader& r, MatchingConfig& c) {
  r.value("max_distance_frame", c.max_distance_frame, 10, 256, "bits");
  r.value("max_distance_strict", c.max_distance_strict, 10, 256, "bits");
  r.value("ratio", c.ratio, 0.3, 1.0);
  r.value("motion_window_px", c.motion_window_px, 3.0, 100.0, "px");
  r.value("map_window_factor", c.map_window_factor, 0.5, 20.0);
  r.value("lost_window_factor", c.lost_window_factor, 0.5, 20.0);
}

void read(config::ConfigReader& r, KeyframeConfig& c) {
  r.value("reference_ratio", c.reference_ratio, 0.0, 1.0);
  r.value("min_close_tracked", c.min_close_tracked, 0, 10000);
  r.value("min_close_new", c.min_close_new, 0, 10000);
  r.value("scarce_inliers", c.scarce_inliers, 0, 10000);
  r.value("max_rotation_rad", c.max_rotation_rad, 0.01, 3.2, "rad");
  r.value("max_translation_m", c.max_translation_m, 0.01, 10.0, "m");
  r.value("known_after_s", c.known_after_s, 0.0, 1e6, "s");
  r.value("min_interval_s", c.min_interval_s, 0.0, 10.0, "s");
  r.value("movable_interval_s", c.movable_interval_s, 0.01, 60.0, "s");
  r.value("movable_interval_frames", c.movable_interval_frames, 1, 1000);
  r.value("static_interval_s", c.static_interval_s, 0.01, 3600.0, "s");
  r.value("changed_share", c.changed_share, 0.01, 1.0);
}

void read(config::ConfigReader& r, MapConfig& c) {
  r.value("min_new_points", c.min_new_points, 0, 10000);
  r.value("min_found_ratio", c.min_found_ratio, 0.0, 1.0);
  r.value("min_observers", c.min_observers, 1, 10);
  r.value("redundant_share", c.redundant_share, 0.1, 1.0);
  r.value("redundant_observers", c.redundant_observers, 1, 20);
  r.value("min_covisible_weight", c.min_covisible_weight, 1, 1000);
  r.value("local_keyframes", c.local_keyframes, 1, 500);
  r.value("max_local_points", c.max_local_points, 100, 100000);
  r.value("pose_only_s", c.pose_only_s, 0.0, 1e9, "s");
  r.value("pose_only_kept", c.pose_only_kept, 1, 100000);
}

void read(config::ConfigReader& r, LocalMappingConfig& c) {
  r.value("free_keyframes", c.free_keyframes, 1, 100);
  r.value("fixed_keyframes", c.fixed_keyframes, 0, 200);
  r.value("max_points", c.max_points, 10, 100000);
  r.value("iterations", c.iterations, 1, 100);
  r.value("fusion_window_px", c.fusion_window_px, 0.5, 50.0, "px");
}

void read(config::ConfigReader& r, RelocalizationConfig& c) {
  r.value("candidates", c.candidates, 1, 100);
  r.value("min_matches", c.min_matches, 6, 1000);
  r.value("min_inliers", c.min_inliers, 10, 1000);
  r.value("ransac_iterations", c.ransac_iterations, 10, 10000);
}

void read(config::ConfigReader& r, QualityConfig& c) {
  r.value("min_features_to_start", c.min_features_to_start, 10, 10000);
  r.value("min_inliers", c.min_inliers, 6, 1000);
  r.value("min_inliers_weak", c.min_inliers_weak, 6, 1000);
  r.value("min_found_share", c.min_found_share, 0.0, 1.0);
  r.value("weak_s", c.weak_s, 0.0, 60.0, "s");
  r.value("by_depth_s", c.by_depth_s, 0.0, 0.5, "s");
  r.value("young_map_s", c.young_map_s, 0.0, 1e6, "s");
}

}  // namespace

void read(config::ConfigReader& reader, TrackerConfig& config) {
  read(reader.section("extraction"), config.extraction);
  read(reader.section("depth"), config.depth);
  read(reader.section("self_calibration"), config.self_calibration);
  read(reader.section("pose"), config.pose);
  read(reader.section("following"), config.following);
  read(reader.section("removal"), config.removal);
  read(reader.section("matching"), config.matching);
  read(reader.section("keyframe"), config.keyframe);
  read(reader.section("map"), config.map);
  read(reader.section("local_mapping"), config.local_mapping);
  read(reader.section("relocalization"), config.relocalization);
  read(reader.section("quality"), config.quality);
  reader.value("localize_only", config.localize_only);
}

}  // namespace rds::tracker
