// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "common/config/config_reader.hpp"
#include "common/geometry/depth_noise.hpp"
#include "common/labels/table.hpp"

namespace rds::mapper {

// What is read from mapper.yaml, and what tests vary; all else is a constant beside the model that it is of.

/// How a keyframe's pictures become points.
struct SamplingConfig {
  int stride_px = 2;         // every stride-th pixel of every stride-th row
  double min_range_m = 0.4;  // depth along the optical axis
  double max_range_m = 4.0;  // farther points are not inserted; their rays pass free space up to here
  int edge_support = 3;      // not read: neighbours on a pixel's surface; with fewer it is a flying pixel
  geometry::DepthNoise depth_noise = geometry::kDepthNoises.front();  // of the camera; the service reads it

  bool operator==(const SamplingConfig&) const = default;
};

/// A static pixel near something dynamic counts only if its surface was seen as static at another time, too.
struct ConfirmationConfig {
  double radius_m = 0.8;  // around what boxes and tracker know as dynamic; 0: all static pixels count
  double apart_s = 1.0;   // not read: so much earlier or later is another time
  bool operator==(const ConfirmationConfig&) const = default;
};

struct ObjectConfig {
  labels::Table labels;          // radius within which two sightings are one object; what is movable is none
  int min_observations = 2;      // an object is reported from here on …
  double min_score_sum = 1.0;    // … if the detector was so sure of it in all
  double flush_min_score = 0.7;  // what does not stand out of its wall is an object from here on

  bool operator==(const ObjectConfig&) const = default;
};

struct OctreeConfig {
  static constexpr double kMinResolutionM = 0.01;
  static constexpr double kMaxResolutionM = 1;

  double resolution_m = 0.05;
  bool color_by_label = true;  // a labelled voxel shows its label's colour
  bool carve_rays = true;      // not read: rays make free space

  bool operator==(const OctreeConfig&) const = default;
};

struct CorrectionConfig {
  int max_keyframes = 5000;  // kept for re-integration; older ones are final
  double memory_mb = 48;     // of keyframes (0.3 MB each at 640×480, stride 2); older ones go to a file
  std::string spill_folder;  // of that file; empty: the system's folder for temporary files

  bool operator==(const CorrectionConfig&) const = default;
};

struct GridConfig {
  std::string up = "auto";     // auto, surfaces, x, -x, y, -y, z, -z: of the map frame
  std::string floor = "auto";  // auto, or the height of the floor along `up` [m]
  double min_height_m = 0.10;  // above the floor
  double max_height_m = 1.80;
  int min_occupied = 1;  // not read: occupied voxels in the band that make a cell an obstacle

  bool operator==(const GridConfig&) const = default;
};

struct MapperConfig {
  SamplingConfig sampling;
  ConfirmationConfig confirmation;
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
