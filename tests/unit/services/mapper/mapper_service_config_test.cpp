// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/mapper_service_config.hpp"

#include <gmock/gmock.h>

namespace rds::mapper {
namespace {

/// Reads the shipped file over `config`; throws what is wrong with it.
MapperServiceConfig read_shipped(MapperServiceConfig config) {
  auto reader = config::ConfigReader::from_file(RDS_SOURCE_DIR "/services/mapper/mapper.yaml");
  read(reader, config);
  reader.finish();
  return config;
}

TEST(MapperServiceConfig, ShippedFileSaysTheDefaults) {
  MapperServiceConfig changed;
  // Values that differ from the defaults, so that a key missing from the file would show.
  changed.lockstep = true;
  changed.expect_boxes = false;
  changed.boxes_timeout_s = 9;
  changed.full_map_every = 9;
  changed.local_correction_every = 9;
  changed.map_file = "x";
  changed.localize_only = true;
  const MapperServiceConfig shipped = read_shipped(changed);
  const MapperServiceConfig defaults;
  EXPECT_EQ(shipped.lockstep, defaults.lockstep);
  EXPECT_EQ(shipped.expect_boxes, defaults.expect_boxes);
  EXPECT_EQ(shipped.boxes_timeout_s, defaults.boxes_timeout_s);
  EXPECT_EQ(shipped.full_map_every, defaults.full_map_every);
  EXPECT_EQ(shipped.local_correction_every, defaults.local_correction_every);
  EXPECT_EQ(shipped.map_file, defaults.map_file);
  EXPECT_EQ(shipped.localize_only, defaults.localize_only);
}

TEST(MapperServiceConfig, ShippedFileSaysTheCoresDefaults) {
  MapperServiceConfig changed;
  MapperConfig& core = changed.mapper;
  core.movable_labels = {};
  core.sampling.stride_px = 9;
  core.sampling.min_range_m = .9;
  core.sampling.max_range_m = .9;
  core.sampling.edge_depth_m = .9;
  core.sampling.edge_support = 9;
  core.region.half_depth_m = .9;
  core.region.margin_px = 9;
  core.region.rim_px = 9;
  core.region.min_component = .9;
  core.region.min_inside = .9;
  core.segmentation.enabled = false;
  core.segmentation.stride = 9;
  core.segmentation.plane_angle_deg = .9;
  core.segmentation.plane_distance_m = .9;
  core.segmentation.min_plane_share = .9;
  core.segmentation.min_cluster_share = .9;
  core.segmentation.cluster_distance = .9;
  core.segmentation.min_overlap = .9;
  core.objects.class_radius_m = {};
  core.objects.default_radius_m = .9;
  core.objects.min_observations = 9;
  core.objects.hit = .9;
  core.objects.miss = .9;
  core.objects.seen_through = .9;
  core.objects.max_existence = .9;
  core.objects.border_weight = .9;
  core.octree.resolution_m = .9;
  core.octree.hit = .9;
  core.octree.miss = .9;
  core.octree.clamp_min = .9;
  core.octree.clamp_max = .9;
  core.octree.carve_rays = false;
  core.octree.color_by_label = false;
  core.octree.label_share = .9;
  core.correction.min_translation_m = .9;
  core.correction.min_rotation_deg = .9;
  core.correction.max_keyframes = 9;
  core.grid.up = "x";
  core.grid.floor = "x";
  core.grid.min_height_m = .9;
  core.grid.max_height_m = .9;
  core.grid.min_occupied = 9;
  const MapperConfig shipped = read_shipped(changed).mapper;
  const MapperConfig defaults;
  EXPECT_EQ(shipped.movable_labels, defaults.movable_labels);
  EXPECT_EQ(shipped.sampling.stride_px, defaults.sampling.stride_px);
  EXPECT_EQ(shipped.sampling.min_range_m, defaults.sampling.min_range_m);
  EXPECT_EQ(shipped.sampling.max_range_m, defaults.sampling.max_range_m);
  EXPECT_EQ(shipped.sampling.edge_depth_m, defaults.sampling.edge_depth_m);
  EXPECT_EQ(shipped.sampling.edge_support, defaults.sampling.edge_support);
  EXPECT_EQ(shipped.region.half_depth_m, defaults.region.half_depth_m);
  EXPECT_EQ(shipped.region.margin_px, defaults.region.margin_px);
  EXPECT_EQ(shipped.region.rim_px, defaults.region.rim_px);
  EXPECT_EQ(shipped.region.min_component, defaults.region.min_component);
  EXPECT_EQ(shipped.region.min_inside, defaults.region.min_inside);
  EXPECT_EQ(shipped.segmentation.enabled, defaults.segmentation.enabled);
  EXPECT_EQ(shipped.segmentation.stride, defaults.segmentation.stride);
  EXPECT_EQ(shipped.segmentation.plane_angle_deg, defaults.segmentation.plane_angle_deg);
  EXPECT_EQ(shipped.segmentation.plane_distance_m, defaults.segmentation.plane_distance_m);
  EXPECT_EQ(shipped.segmentation.min_plane_share, defaults.segmentation.min_plane_share);
  EXPECT_EQ(shipped.segmentation.min_cluster_share, defaults.segmentation.min_cluster_share);
  EXPECT_EQ(shipped.segmentation.cluster_distance, defaults.segmentation.cluster_distance);
  EXPECT_EQ(shipped.segmentation.min_overlap, defaults.segmentation.min_overlap);
  EXPECT_EQ(shipped.objects.class_radius_m, defaults.objects.class_radius_m);
  EXPECT_EQ(shipped.objects.default_radius_m, defaults.objects.default_radius_m);
  EXPECT_EQ(shipped.objects.min_observations, defaults.objects.min_observations);
  EXPECT_EQ(shipped.objects.hit, defaults.objects.hit);
  EXPECT_EQ(shipped.objects.miss, defaults.objects.miss);
  EXPECT_EQ(shipped.objects.seen_through, defaults.objects.seen_through);
  EXPECT_EQ(shipped.objects.max_existence, defaults.objects.max_existence);
  EXPECT_EQ(shipped.objects.border_weight, defaults.objects.border_weight);
  EXPECT_EQ(shipped.octree.resolution_m, defaults.octree.resolution_m);
  EXPECT_EQ(shipped.octree.hit, defaults.octree.hit);
  EXPECT_EQ(shipped.octree.miss, defaults.octree.miss);
  EXPECT_EQ(shipped.octree.clamp_min, defaults.octree.clamp_min);
  EXPECT_EQ(shipped.octree.clamp_max, defaults.octree.clamp_max);
  EXPECT_EQ(shipped.octree.carve_rays, defaults.octree.carve_rays);
  EXPECT_EQ(shipped.octree.color_by_label, defaults.octree.color_by_label);
  EXPECT_EQ(shipped.octree.label_share, defaults.octree.label_share);
  EXPECT_EQ(shipped.correction.min_translation_m, defaults.correction.min_translation_m);
  EXPECT_EQ(shipped.correction.min_rotation_deg, defaults.correction.min_rotation_deg);
  EXPECT_EQ(shipped.correction.max_keyframes, defaults.correction.max_keyframes);
  EXPECT_EQ(shipped.grid.up, defaults.grid.up);
  EXPECT_EQ(shipped.grid.floor, defaults.grid.floor);
  EXPECT_EQ(shipped.grid.min_height_m, defaults.grid.min_height_m);
  EXPECT_EQ(shipped.grid.max_height_m, defaults.grid.max_height_m);
  EXPECT_EQ(shipped.grid.min_occupied, defaults.grid.min_occupied);
}

}  // namespace
}  // namespace rds::mapper
