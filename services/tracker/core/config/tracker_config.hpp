// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/geometry/depth_noise.hpp"

namespace rds::config {
class ConfigReader;
}

namespace rds::tracker {

/// ORB features.
struct ExtractionConfig {
  static constexpr int kMostLevels = 12;
  static constexpr double kMinFactor = 1.05;
  static constexpr double kMaxFactor = 2;

  int features = 1000;         // wanted per picture
  int levels = 8;              // of the pyramid
  double scale_factor = 1.2;   // between levels
  int fast_threshold = 20;     // grey levels
  int fast_threshold_low = 7;  // where a cell shows no corner with the first

  bool operator==(const ExtractionConfig&) const = default;
};

/// The depth sensor.
struct DepthConfig {
  double max_depth_m = 8.0;    // beyond: as if not measured
  double close_depth_m = 3.2;  // points nearer than this are made into map points at once
  bool triangulate = true;     // points of features without depth are made, where three keyframes see them
  geometry::DepthNoise noise = geometry::kDepthNoises.front();  // the service reads it

  bool operator==(const DepthConfig&) const = default;
};

/// What is learned about the camera while it runs.
struct SelfCalibrationConfig {
  bool readout = true;       // how long reading a picture takes; false: readout_s is true
  double readout_s = 0;      // from the first row to the last (rolling shutter), to start with
  bool focal_length = true;  // false: the given one is true

  bool operator==(const SelfCalibrationConfig&) const = default;
};

/// Following map points from picture to picture by how they look.
struct FollowingConfig {
  bool enabled = true;  // false: features are extracted and matched in every frame
  int points = 400;     // followed

  bool operator==(const FollowingConfig&) const = default;
};

/// What of a picture is not trusted because something that can move shows there.
struct RemovalConfig {
  std::string method = "depth";  // or "box": all that a predicted box shows; "off": nothing
  bool motion = true;            // with "depth": also what stands where nothing stood before

  bool operator==(const RemovalConfig&) const = default;
};

/// How often a tracked frame becomes a keyframe.
struct KeyframeConfig {
  double movable_interval_s = 0.1;  // longest, while movable objects are there or the picture changes
  double static_interval_s = 1.0;   // longest, otherwise
  double known_after_s = 5;         // a view that a keyframe has for so long needs no other

  bool operator==(const KeyframeConfig&) const = default;
};

/// Where a map begins.
struct MapFrameConfig {
  bool level = true;  // z points up, as floors and walls of the first picture say; false: the map's frame is
                      // the first picture's optical frame
  std::vector<double> up_in_camera;  // x, y, z of the direction up in that frame, where it is known; or empty

  bool operator==(const MapFrameConfig&) const = default;
};

struct TrackerConfig {
  ExtractionConfig extraction;
  DepthConfig depth;
  SelfCalibrationConfig self_calibration;
  FollowingConfig following;
  RemovalConfig removal;
  KeyframeConfig keyframe;
  MapFrameConfig map_frame;
  double young_map_s = 5;       // of tracking; a younger map is given up by who is lost in it for as long
  double submap_after_s = 1;    // of being lost, a submap begins; 0: never
  bool localize_only = false;   // in the map that it starts from; keyframes are temporary
  bool keep_all_poses = false;  // of keyframes in a known place; else those of a minute

  bool operator==(const TrackerConfig&) const = default;
};

/// Reads section by section; an absent key keeps its default.
void read(config::ConfigReader& reader, TrackerConfig& config);

}  // namespace rds::tracker
