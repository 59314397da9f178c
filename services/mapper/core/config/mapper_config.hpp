// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/config/config_reader.hpp"
#include "common/labels/table.hpp"

namespace rds::mapper {

/// How a keyframe's pictures become points.
struct SamplingConfig {
  int stride_px = 2;           // every stride-th pixel of every stride-th row
  double min_range_m = 0.4;    // depth along the optical axis
  double max_range_m = 4.0;    // farther points are not inserted; their rays carve up to here
  double edge_depth_m = 0.03;  // neighbours nearer in depth than this × max(1, depth / 1 m) support a pixel
  int edge_support = 3;        // of 8 neighbours; fewer: a flying pixel at a depth edge, rejected

  bool operator==(const SamplingConfig&) const = default;
};

/// Depth cut of an object inside its box (NGD-SLAM's trick, know-how of the field).
struct RegionConfig {
  double half_depth_m = 0.35;  // object = |depth − object depth| below this
  int margin_px = 24;          // the box is widened by this before the cut
  int rim_px = 8;              // around a dynamic object: unknown
  double sure_part = 0.05;     // parts of its depth cut smaller than this share of the largest are unknown
  double min_inside = 0.05;    // a part must lie inside the unwidened box by this share

  bool operator==(const RegionConfig&) const = default;
};

/// A static pixel near something dynamic counts only if its surface was seen as static at another time, too.
struct ConfirmationConfig {
  double radius_m = 0.8;         // around what boxes and tracker know as dynamic; 0: no pixel is in doubt
  double apart_s = 1.0;          // so much earlier or later is another time
  double share = 0.7;            // of a connected surface that must have been seen then
  double large = 0.1;            // a surface that fills this share of the picture ...
  double share_of_large = 0.15;  // ... needs less
  double passing_share = 0.8;    // of a surface that must be transient for it to be left out

  [[nodiscard]] std::int64_t apart_ns() const { return static_cast<std::int64_t>(apart_s * 1e9); }
  bool operator==(const ConfirmationConfig&) const = default;
};

struct SegmentationConfig {
  bool enabled = true;
  int stride = 2;                  // of the sampled points
  double plane_distance_m = 0.01;  // of a pixel from its plane, and besides ...
  double plane_noise = 0.006;      // ... x depth² [1/m]: two standard deviations of structured light
  double min_plane_share = 0.033;  // of the picture (10 000 px of 640×480)
  double min_cluster_share = 0.0033;
  double cluster_distance = 0.015;  // between neighbours, × depth

  bool operator==(const SegmentationConfig&) const = default;
};

struct ObjectConfig {
  labels::Table labels;          // radius within which two sightings are one object; what is movable is none
  int min_observations = 2;      // an object is reported from here on …
  double min_score_sum = 1.0;    // … if the detector was so sure of it in all
  double flush_min_score = 0.7;  // what does not stand out of its wall is an object from here on
  double hit = 0.85;             // log-odds of existence per observation
  double miss = 0.05;            // not detected though in view
  double seen_through = 0.6;     // the camera measured something behind it
  double max_existence = 3.5;
  double border_weight = 0.25;  // of an observation cut by the picture's border

  bool operator==(const ObjectConfig&) const = default;
};

struct OctreeConfig {
  double resolution_m = 0.05;
  double hit = 0.85;        // paper §IV-C: static point
  double miss = -0.41;      // paper §IV-C: movable point; also rays
  double clamp_min = 0.12;  // probabilities
  double clamp_max = 0.97;
  bool carve_rays = true;      // free space along rays of static pixels
  double suspect_miss = -1.2;  // rays through ghosts, see Doubt
  int weak_sightings = 2;      // voxels hit no more often are lowered by rays without return; 0: no such ray
  bool color_by_label = true;  // a labelled voxel shows its label's colour
  double label_share = 0.25;   // of a voxel's votes that a label needs

  bool operator==(const OctreeConfig&) const = default;
};

struct CorrectionConfig {
  double min_translation_m = 0.01;  // smaller pose corrections wait for settle()
  double min_rotation_deg = 0.5;
  int max_keyframes = 5000;  // kept for re-integration; older ones are final
  double memory_mb = 48;     // of keyframes (0.3 MB each at 640×480, stride 2); older ones go to a file
  std::string spill_folder;  // of that file; empty: the system's folder for temporary files

  bool operator==(const CorrectionConfig&) const = default;
};

struct GridConfig {
  std::string up = "auto";     // auto, x, -x, y, -y, z, -z: of the map frame
  std::string floor = "auto";  // auto, or the height of the floor along `up` [m]
  double min_height_m = 0.10;  // above the floor
  double max_height_m = 1.80;
  int min_occupied = 1;  // occupied voxels in the band that make a cell an obstacle

  bool operator==(const GridConfig&) const = default;
};

struct MapperConfig {
  SamplingConfig sampling;
  RegionConfig region;
  ConfirmationConfig confirmation;
  SegmentationConfig segmentation;
  ObjectConfig objects;
  OctreeConfig octree;
  CorrectionConfig correction;
  GridConfig grid;

  [[nodiscard]] bool is_movable(const std::string& label) const;

  bool operator==(const MapperConfig&) const = default;
};

/// Reads the sections of mapper.yaml; every violation is collected by the reader.
void read(config::ConfigReader& reader, MapperConfig& config);

}  // namespace rds::mapper
