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
}

void read(ConfigReader& r, ConfirmationConfig& c) {
  r.value("radius_m", c.radius_m, 0.0, 5.0, "m");
}

void read(ConfigReader& r, ObjectConfig& c) {
  r.value("min_observations", c.min_observations, 1, 100);
  r.value("min_score_sum", c.min_score_sum, 0.0, 100.0);
  r.value("flush_min_score", c.flush_min_score, 0.0, 1.0);
}

void read(ConfigReader& r, OctreeConfig& c) {
  r.value("resolution_m", c.resolution_m, OctreeConfig::kMinResolutionM, OctreeConfig::kMaxResolutionM, "m");
  r.value("color_by_label", c.color_by_label);
}

void read(ConfigReader& r, CorrectionConfig& c) {
  r.value("max_keyframes", c.max_keyframes, 1, 100000);
  r.value("memory_mb", c.memory_mb, 0.0, 1e6, "MB");
  r.value("spill_folder", c.spill_folder);
}

void read(ConfigReader& r, GridConfig& c) {
  r.choice("up", c.up, {"auto", "surfaces", "x", "-x", "y", "-y", "z", "-z"});
  r.value("floor", c.floor);
  char* end = nullptr;
  const double floor_m = std::strtod(c.floor.c_str(), &end);
  if (c.floor != "auto" && (c.floor.empty() || *end != '\0' || !std::isfinite(floor_m)))
    r.violation("floor", c.floor, "expected auto or a height [m]");
  r.value("min_height_m", c.min_height_m, -10.0, 10.0, "m");
  r.value("max_height_m", c.max_height_m, -10.0, 10.0, "m");
  if (c.min_height_m >= c.max_height_m)
    r.violation("min_height_m", fmt::format("{}", c.min_height_m), "expected less than max_height_m [m]");
}

}  // namespace

bool MapperConfig::is_movable(const std::string& label) const {
  return objects.labels[label].movable;
}

void read(ConfigReader& reader, MapperConfig& config) {
  labels::read(reader, config.objects.labels);
  read(reader.section("sampling"), config.sampling);
  read(reader.section("confirmation"), config.confirmation);
  read(reader.section("objects"), config.objects);
  read(reader.section("octree"), config.octree);
  read(reader.section("correction"), config.correction);
  read(reader.section("grid"), config.grid);
}

}  // namespace rds::mapper
