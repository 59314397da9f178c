// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/prediction/prediction_config.hpp"


namespace rds::tracker::prediction {
namespace {

void read(config::ConfigReader& reader, PlaneSortConfig& config) {
  reader.value("min_iou", config.min_iou, 0.0, 1.0);
  reader.value("max_age_s", config.max_age_s, 0.0, 60.0, "s");
  reader.value("units_per_metre", config.units_per_metre, 1.0, 10000.0);
  reader.value("frames_per_second", config.frames_per_second, 0.1, 1000.0, "1/s");
}

void read(config::ConfigReader& reader, Kalman3dConfig& config) {
  reader.value("acceleration", config.acceleration, 0.01, 100.0, "m/s^2");
  reader.value("lateral_noise_m", config.lateral_noise_m, 0.001, 10.0, "m");
  reader.value("vertical_share", config.vertical_share, 0.01, 1.0);
  reader.value("vertical_noise_m", config.vertical_noise_m, 0.001, 10.0, "m");
  reader.value("depth_noise_m", config.depth_noise_m, 0.001, 10.0, "m");
  reader.value("initial_speed", config.initial_speed, 0.01, 100.0, "m/s");
  reader.value("size_noise_m", config.size_noise_m, 0.001, 10.0, "m");
  reader.value("size_drift", config.size_drift, 0.001, 100.0, "m");
  reader.value("min_width_m", config.min_width_m, 0.0, 10.0, "m");
  reader.value("max_misses", config.max_misses, 0, 1000);
  reader.value("gate_sigma", config.gate_sigma, 0.1, 100.0);
  reader.value("max_distance_m", config.max_distance_m, 0.01, 100.0, "m");
  reader.value("max_age_s", config.max_age_s, 0.0, 60.0, "s");
  reader.value("growth_sigma", config.growth_sigma, 0.0, 10.0);
  reader.value("max_growth_m", config.max_growth_m, 0.0, 10.0, "m");
}

void read(config::ConfigReader& reader, RegionConfig& config) {
  reader.value("margin_px", config.margin_px, 0.0, 200.0, "px");
  reader.value("margin_depth_m", config.margin_depth_m, 0.0, 10.0, "m");
}

}  // namespace

void read(config::ConfigReader& reader, PredictionConfig& config) {
  reader.choice("algorithm", config.algorithm, {"paper", "kalman3d"});
  reader.value("min_score", config.min_score, 0.0, 1.0);
  reader.value("reach_share", config.reach_share, 0.0, 1.0);
  reader.value("duplicate_overlap", config.duplicate_overlap, 0.01, 1.0);
  reader.value("doubtful_share", config.doubtful_share, 0.0, 1.0);
  reader.value("doubtful_score", config.doubtful_score, 0.0, 1.0);
  reader.value("border_px", config.border_px, 0.0, 200.0, "px");
  read(reader.section("paper"), config.paper);
  read(reader.section("kalman3d"), config.kalman3d);
  read(reader.section("region"), config.region);
}

bool is_movable(const PredictionConfig& config, std::string_view label) {
  return config.labels[label].movable;
}

}  // namespace rds::tracker::prediction
