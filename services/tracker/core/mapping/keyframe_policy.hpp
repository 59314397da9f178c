// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/tracker/core/config/tracker_config.hpp"
#include "services/tracker/core/pose/association.hpp"

namespace rds::tracker {

/// What the decision about a keyframe rests on.
struct KeyframeFacts {
  double since_last_s = 0;          // since the last keyframe
  int frames_since_last = 1000;     // tracked since then
  double since_map_s = 1000;        // since the last keyframe of the map
  int inliers = 0;                  // map points that support the frame's pose
  int seen = 0;                     // how much of the map shows: points, or cells of the picture with points
  int seen_by_reference = 0;        // the same of the view that it is compared with
  bool has_depth = false;           // without, map points can be made by triangulation only
  bool triangulates = false;        // and they are
  int close_tracked = 0;            // of the inliers, those at close depth
  int close_new = 0;                // close features without map point
  double view_change = 0;           // from the nearest keyframe around, as view_change() says
  bool movable_or_changed = false;  // movable objects are there, or the picture changes faster than the view
};

/// Largest change of view that needs no keyframe of its own.
inline constexpr double kMaxRotationRad = 0.26;   // 15°
inline constexpr double kMaxTranslationM = 0.15;  // for a scene 2 m away

/// How far a view is from another one: 1 where the scene looks different enough for a keyframe of its own.
///
/// @param median_depth_m  of the scene: the farther it is away, the less a step changes.
double view_change(const Pose& from_other_view, double median_depth_m);

/// What a frame should become.
enum class KeyframeNeed : std::uint8_t {
  kNone,
  kDetector,  // a keyframe for the detector and the mapper; the SLAM map has what it shows
  kMap        // a keyframe of the map, and for them
};

/// The map needs a frame whose view no keyframe has, or that sees less of the map than others there did; all
/// it can get while movable objects hide nearly everything. The detector, which looks at keyframes only,
/// needs one often while the picture changes, seldom in a static scene; a picture without depth tells it
/// nothing. Source: Mur-Artal & Tardós 2017,
/// §III-E; the paper, §III-A (keyframes allocate the detector's time).
KeyframeNeed keyframe_need(const KeyframeFacts& facts, const KeyframeConfig& config);

}  // namespace rds::tracker
