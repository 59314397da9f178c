// SPDX-License-Identifier: Apache-2.0
#include "services/loop_closer/core/loop_closer_config.hpp"

namespace rds::loop_closer {
namespace {

void read(config::ConfigReader& r, vision::PlaceIndexConfig& c) {
  r.value("tables", c.tables, 1, 12);
  r.value("max_signature_bits", c.max_signature_bits, 0, 64, "bits");
}

void read(config::ConfigReader& r, CandidateConfig& c) {
  r.value("min_gap_keyframes", c.min_gap_keyframes, 1, 1000, "keyframes");
  r.value("min_score", c.min_score, 0.0, 1.0);
  r.value("max_candidates", c.max_candidates, 1, 20);
  r.value("min_separation_keyframes", c.min_separation_keyframes, 0, 100, "keyframes");
}

void read(config::ConfigReader& r, vision::DescriptorMatchConfig& c) {
  r.value("max_distance", c.max_distance, 0, 256, "bits");
  r.value("max_ratio", c.max_ratio, 0.1, 1.0);
}

void read(config::ConfigReader& r, VerificationConfig& c) {
  r.value("max_depth_m", c.max_depth_m, 0.5, 100.0, "m");
  r.value("ransac_iterations", c.ransac_iterations, 10, 10'000);
  r.value("max_ray_error", c.max_ray_error, 0.0005, 0.1);
  r.value("max_inverse_depth_error", c.max_inverse_depth_error, 0.001, 1.0, "1/m");
  r.value("min_ransac_inliers", c.min_ransac_inliers, 4, 1000);
  r.value("min_inliers", c.min_inliers, 6, 1000);
  r.value("search_radius", c.search_radius, 0.001, 0.2);
  r.value("min_inlier_share", c.min_inlier_share, 0.0, 1.0);
  r.value("min_extent_m", c.min_extent_m, 0.0, 10.0, "m");
}

void read(config::ConfigReader& r, ConsistencyConfig& c) {
  r.value("min_detections", c.min_detections, 1, 20);
  r.value("window_keyframes", c.window_keyframes, 1, 100, "keyframes");
  r.value("max_difference_m", c.max_difference_m, 0.001, 10.0, "m");
  r.value("max_difference_rad", c.max_difference_rad, 0.001, 3.0, "rad");
  r.value("min_correction_m", c.min_correction_m, 0.0, 10.0, "m");
  r.value("min_correction_rad", c.min_correction_rad, 0.0, 3.0, "rad");
  r.value("max_drift_share", c.max_drift_share, 0.0, 10.0);
  r.value("max_drift_floor_m", c.max_drift_floor_m, 0.0, 100.0, "m");
  r.value("max_drift_rad", c.max_drift_rad, 0.01, 3.15, "rad");
}

void read(config::ConfigReader& r, PoseGraphConfig& c) {
  r.value("max_iterations", c.max_iterations, 1, 1000);
  r.value("max_covisible_edges", c.max_covisible_edges, 0, 100);
  r.value("min_covisible_weight", c.min_covisible_weight, 1, 10'000, "map points");
  r.value("edge_sigma_m", c.edge_sigma_m, 1e-5, 1.0, "m");
  r.value("edge_sigma_rad", c.edge_sigma_rad, 1e-5, 1.0, "rad");
  r.value("loop_sigma_m", c.loop_sigma_m, 1e-5, 1.0, "m");
  r.value("loop_sigma_rad", c.loop_sigma_rad, 1e-5, 1.0, "rad");
  r.value("max_loop_residual_m", c.max_loop_residual_m, 0.001, 10.0, "m");
  r.value("max_loop_residual_rad", c.max_loop_residual_rad, 0.001, 3.0, "rad");
}

}  // namespace

void read(config::ConfigReader& reader, LoopCloserConfig& config) {
  reader.value("max_features", config.max_features, 50, 10'000);
  read(reader.section("place_index"), config.place_index);
  read(reader.section("candidates"), config.candidates);
  read(reader.section("matching"), config.matching);
  read(reader.section("verification"), config.verification);
  read(reader.section("consistency"), config.consistency);
  read(reader.section("pose_graph"), config.pose_graph);
}

}  // namespace rds::loop_closer
