// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/config/mapper_config.hpp"

#include <cmath>
#include <cstdlib>

namespace rds::mapper {
namespace {

using config::ConfigReader;

void read(ConfigReader& r, SamplingConfig& c) {
  r.value("stride_px", c.stride_px, 1, 16, "px");
  r.value("min_range_m", c.min_range_m, 0.05, 5.0, "m");
  r.value("max_range_m", c.max_range_m, 0.5, 6.5, "m");
  if (c.min_range_m >= c.max_range_m)
    r.violation("min_range_m", fmt::format("{}", c.min_range_m), "expected less than max_range_m [m]");
  r.value("edge_depth_m", c.edge_depth_m, 0.001, 1.0, "m");
  r.value("edge_support", c.edge_support, 0, 8);
}

void read(ConfigReader& r, RegionConfig& c) {
  r.value("half_depth_m", c.half_depth_m, 0.05, 2.0, "m");
  r.value("margin_px", c.margin_px, 0, 200, "px");
  r.value("rim_px", c.rim_px, 0, 50, "px");
  r.value("sure_part", c.sure_part, 0.0, 1.0);
  r.value("min_inside", c.min_inside, 0.0, 1.0);
}

void read(ConfigReader& r, ConfirmationConfig& c) {
  r.value("radius_m", c.radius_m, 0.0, 5.0, "m");
  r.value("apart_s", c.apart_s, 0.0, 60.0, "s");
  r.value("share", c.share, 0.0, 1.0);
  r.value("large", c.large, 0.0, 1.0);
  r.value("share_of_large", c.share_of_large, 0.0, 1.0);
  r.value("passing_share", c.passing_share, 0.0, 1.0);
}

void read(ConfigReader& r, SegmentationConfig& c) {
  r.value("enabled", c.enabled);
  r.value("stride", c.stride, 1, 8);
  r.value("plane_distance_m", c.plane_distance_m, 0.001, 0.5, "m");
  r.value("plane_noise", c.plane_noise, 0.0, 0.1, "1/m");
  r.value("min_plane_share", c.min_plane_share, 0.001, 1.0);
  r.value("min_cluster_share", c.min_cluster_share, 0.0001, 1.0);
  r.value("cluster_distance", c.cluster_distance, 0.001, 0.5);
}

void read(ConfigReader& r, ObjectConfig& c) {
  r.value("min_observations", c.min_observations, 1, 100);
  r.value("min_score_sum", c.min_score_sum, 0.0, 100.0);
  r.value("flush_min_score", c.flush_min_score, 0.0, 1.0);
  r.value("hit", c.hit, 0.01, 10.0);
  r.value("miss", c.miss, 0.0, 10.0);
  r.value("seen_through", c.seen_through, 0.0, 10.0);
  r.value("max_existence", c.max_existence, 0.1, 100.0);
  r.value("border_weight", c.border_weight, 0.01, 1.0);
}

void read(ConfigReader& r, OctreeConfig& c) {
  r.value("resolution_m", c.resolution_m, 0.01, 1.0, "m");
  r.value("hit", c.hit, 0.01, 5.0);
  r.value("miss", c.miss, -5.0, -0.01);
  r.value("suspect_miss", c.suspect_miss, -10.0, -0.01);
  r.value("clamp_min", c.clamp_min, 0.001, 0.49);
  r.value("clamp_max", c.clamp_max, 0.51, 0.999);
  r.value("carve_rays", c.carve_rays);
  r.value("weak_sightings", c.weak_sightings, 0, 32);
  r.value("color_by_label", c.color_by_label);
  r.value("label_share", c.label_share, 0.0, 1.0);
}

void read(ConfigReader& r, CorrectionConfig& c) {
  r.value("min_translation_m", c.min_translation_m, 0.0, 10.0, "m");
  r.value("min_rotation_deg", c.min_rotation_deg, 0.0, 180.0, "deg");
  r.value("max_keyframes", c.max_keyframes, 1, 100000);
  r.value("memory_mb", c.memory_mb, 0.0, 1e6, "MB");
  r.value("spill_folder", c.spill_folder);
}

void read(ConfigReader& r, GridConfig& c) {
  r.choice("up", c.up, {"auto", "x", "-x", "y", "-y", "z", "-z"});
  r.value("floor", c.floor);
  char* end = nullptr;
  const double floor_m = std::strtod(c.floor.c_str(), &end);
  if (c.floor != "auto" && (c.floor.empty() || *end != '\0' || !std::isfinite(floor_m)))
    r.violation("floor", c.floor, "expected auto or a height [m]");
  r.value("min_height_m", c.min_height_m, -10.0, 10.0, "m");
  r.value("max_height_m", c.max_height_m, -10.0, 10.0, "m");
  if (c.min_height_m >= c.max_height_m)
    r.violation("min_height_m", fmt::format("{}", c.min_height_m), "expected less than max_height_m [m]");
  r.value("min_occupied", c.min_occupied, 1, 100);
}

}  // namespace

bool MapperConfig::is_movable(const std::string& label) const {
  return objects.labels[label].movable;
}

void read(ConfigReader& reader, MapperConfig& config) {
  labels::read(reader, config.objects.labels);
  read(reader.section("sampling"), config.sampling);
  read(reader.section("region"), config.region);
  read(reader.section("confirmation"), config.confirmation);
  read(reader.section("segmentation"), config.segmentation);
  read(reader.section("objects"), config.objects);
  read(reader.section("octree"), config.octree);
  read(reader.section("correction"), config.correction);
  read(reader.section("grid"), config.grid);
}

}  // namespace rds::mapper
