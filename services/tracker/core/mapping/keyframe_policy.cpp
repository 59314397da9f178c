// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/mapping/keyframe_policy.hpp"

#include <algorithm>

namespace rds::tracker {
namespace {

constexpr double kUsualDepth = 2;         // m, that kMaxTranslationM is meant for
constexpr double kMinIntervalS = 0.09;    // between keyframes, unless tracking is about to fail
constexpr int kMinMovableFrames = 3;      // between keyframes while movable objects are there
constexpr double kReferenceRatio = 0.75;  // fewer inliers than this share of the reference keyframe's points
constexpr int kMinCloseTracked = 100;     // fewer close points tracked than this …
constexpr int kMinCloseNew = 70;          // … while more than this could be made
constexpr int kScarceInliers = 200;       // with fewer among movable objects, the map takes every keyframe
constexpr double kUrgentShare = 0.4;      // of kScarceInliers: tracking is about to fail

}  // namespace

double view_change(const Pose& from_other_view, double median_depth_m) {
  const double depth_ratio = std::clamp(median_depth_m / kUsualDepth, 0.25, 4.0);
  return std::max(geometry::rotation_angle_rad(from_other_view.linear()) / kMaxRotationRad,
                  from_other_view.translation().norm() / (kMaxTranslationM * depth_ratio));
}

KeyframeNeed keyframe_need(const KeyframeFacts& facts, const KeyframeConfig& config) {
  const bool scarce = facts.movable_or_changed && facts.inliers < kScarceInliers;
  const bool urgent = scarce && facts.inliers < kUrgentShare * kScarceInliers;
  const bool gives_points = facts.has_depth || facts.triangulates;
  // A keyframe for the detector gives the map nothing; it waits for its own last one.
  const double since_last_s = scarce ? facts.since_map_s : facts.since_last_s;
  if (!gives_points || (since_last_s < kMinIntervalS && !urgent)) return KeyframeNeed::kNone;
  const bool losing_reference = facts.seen < kReferenceRatio * facts.seen_by_reference;
  const bool close_points_wanted = facts.close_tracked < kMinCloseTracked && facts.close_new > kMinCloseNew;
  const double longest = facts.movable_or_changed ? config.movable_interval_s : config.static_interval_s;
  // Stamps jitter by milliseconds; a frame earlier is nearer than a frame later.
  constexpr double kJitter = 0.01;
  if (urgent || losing_reference || close_points_wanted || facts.view_change > 1) return KeyframeNeed::kMap;
  const bool is_soon_after_last = !scarce && facts.frames_since_last < kMinMovableFrames;
  if (since_last_s < longest - kJitter || is_soon_after_last) return KeyframeNeed::kNone;
  if (scarce) return KeyframeNeed::kMap;
  return facts.has_depth ? KeyframeNeed::kDetector : KeyframeNeed::kNone;
}

}  // namespace rds::tracker
