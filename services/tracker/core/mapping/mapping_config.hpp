// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace rds::tracker {

/// When a tracked frame becomes a keyframe.
struct KeyframeConfig {
  double reference_ratio = 0.75;  // fewer inliers than this share of the reference keyframe's points
  int min_close_tracked = 100;    // fewer close points tracked than this …
  int min_close_new = 70;         // … while more than this could be made
  int scarce_inliers = 200;       // with fewer, while movable objects are there, the map takes every keyframe
  double max_rotation_rad = 0.26;   // view change since the last keyframe
  double max_translation_m = 0.15;  // the same, for a scene 2 m away
  double known_after_s = 5;         // a view that a keyframe has for so long needs no other
  double min_interval_s = 0.09;     // between keyframes, unless tracking is about to fail
  double movable_interval_s = 0.1;  // longest, while movable objects are there or the picture changes; but
  int movable_interval_frames = 3;  // … not less than so many frames
  double static_interval_s = 1.0;   // longest, otherwise
  double changed_share = 0.35;      // drop of the share of expected points found that counts as a change
  bool operator==(const KeyframeConfig&) const = default;
};

/// Local mapping: fusion of map points and local bundle adjustment.
struct LocalMappingConfig {
  int free_keyframes = 15;      // moved by bundle adjustment, the new one included
  int fixed_keyframes = 12;     // also see the points and hold them
  int max_points = 1600;        // of one job, most observed first
  int iterations = 4;           // of each of the two passes
  double fusion_window_px = 3;  // around the projection, at level 0
  bool operator==(const LocalMappingConfig&) const = default;
};

}  // namespace rds::tracker
