// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace rds::tracker {

/// Life of map points and keyframes.
struct MapConfig {
  int min_new_points = 100;       // nearest points made from a keyframe even if not close
  double min_found_ratio = 0.25;  // a map point found more rarely where it should be seen goes
  int min_observers = 2;          // keyframes that must see a point two keyframes on
  double redundant_share = 0.9;   // a keyframe goes when this share of its close points …
  int redundant_observers = 3;    // … is seen in so many others
  int min_covisible_weight = 15;  // shared points that make a covisibility edge
  int local_keyframes = 24;       // of the local map
  int max_local_points = 4000;    // of the local map
  // Keyframes of which only the pose is kept: those of this time, and so many more per reference keyframe.
  double pose_only_s = 60;  // 0: all
  int pose_only_kept = 20;
  bool operator==(const MapConfig&) const = default;
};

}  // namespace rds::tracker
