// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/config/tracker_config.hpp"

#include <fmt/ranges.h>

#include "common/config/config_reader.hpp"

namespace rds::tracker {
namespace {

void read(config::ConfigReader& r, ExtractionConfig& c) {
  r.value("features", c.features, 100, 10000);
  r.value("levels", c.levels, 1, ExtractionConfig::kMostLevels);
  r.value("scale_factor", c.scale_factor, ExtractionConfig::kMinFactor, ExtractionConfig::kMaxFactor);
  r.value("fast_threshold", c.fast_threshold, 2, 100, "grey levels");
  r.value("fast_threshold_low", c.fast_threshold_low, 2, 100, "grey levels");
}

void read(config::ConfigReader& r, DepthConfig& c) {
  r.value("max_depth_m", c.max_depth_m, 0.5, 100.0, "m");
  r.value("close_depth_m", c.close_depth_m, 0.3, 100.0, "m");
  r.value("triangulate", c.triangulate);
}

void read(config::ConfigReader& r, SelfCalibrationConfig& c) {
  r.value("readout", c.readout);
  r.value("readout_s", c.readout_s, -0.05, 0.05, "s");
  r.value("focal_length", c.focal_length);
}

void read(config::ConfigReader& r, FollowingConfig& c) {
  r.value("enabled", c.enabled);
  r.value("points", c.points, 50, 5000);
}

void read(config::ConfigReader& r, RemovalConfig& c) {
  r.choice("method", c.method, {"depth", "box", "off"});
  r.value("motion", c.motion);
}

void read(config::ConfigReader& r, KeyframeConfig& c) {
  r.value("movable_interval_s", c.movable_interval_s, 0.01, 60.0, "s");
  r.value("static_interval_s", c.static_interval_s, 0.01, 3600.0, "s");
}

void read(config::ConfigReader& r, MapFrameConfig& c) {
  r.value("level", c.level);
  r.value("up_in_camera", c.up_in_camera);
  double squares = 0;
  for (const double along : c.up_in_camera) squares += along * along;
  if (!c.up_in_camera.empty() && (c.up_in_camera.size() != 3 || !(squares > 1e-6) || !(squares < 1e6)))
    r.violation("up_in_camera", fmt::format("[{}]", fmt::join(c.up_in_camera, ", ")),
                "expected [x, y, z], a direction, or []");
}

}  // namespace

void read(config::ConfigReader& reader, TrackerConfig& config) {
  read(reader.section("extraction"), config.extraction);
  read(reader.section("depth"), config.depth);
  read(reader.section("self_calibration"), config.self_calibration);
  read(reader.section("following"), config.following);
  read(reader.section("removal"), config.removal);
  read(reader.section("keyframe"), config.keyframe);
  read(reader.section("map_frame"), config.map_frame);
  config::ConfigReader& quality = reader.section("quality");
  quality.value("young_map_s", config.young_map_s, 0.0, 1e6, "s");
  quality.value("submap_after_s", config.submap_after_s, 0.0, 1e6, "s");
  reader.value("localize_only", config.localize_only);
}

}  // namespace rds::tracker
