// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/mapping/keyframe_policy.hpp"

#include <algorithm>

namespace rds::tracker {
namespace {

constexpr double kUrgentShare = 0.4;  // of scarce_inliers
constexpr double kUsualDepth = 2;     // m, that max_translation_m is meant for

}  // namespace

double view_change(const Pose& from_other_view, double median_depth_m, const KeyframeConfig& config) {
  const double depth_ratio = std::clamp(median_depth_m / kUsualDepth, 0.25, 4.0);
  return std::max(geometry::rotation_angle_rad(from_other_view.linear()) / config.max_rotation_rad,
                  from_other_view.translation().norm() / (config.max_translation_m * depth_ratio));
}

KeyframeNeed keyframe_need(const KeyframeFacts& facts, const KeyframeConfig& config) {
  const bool scarce = facts.movable_or_changed && facts.inliers < config.scarce_inliers;
  const bool urgent = scarce && facts.inliers < kUrgentShare * config.scarce_inliers;
  if (!facts.has_depth || (facts.since_last_s < config.min_interval_s && !urgent)) return KeyframeNeed::kNone;
  const bool losing_reference = facts.seen < config.reference_ratio * facts.seen_by_reference;
  const bool close_points_wanted =
      facts.close_tracked < config.min_close_tracked && facts.close_new > config.min_close_new;
  const double longest = facts.movable_or_changed ? config.movable_interval_s : config.static_interval_s;
  // Stamps jitter by milliseconds; a frame earlier is nearer than a frame later.
  constexpr double kJitter = 0.01;
  if (urgent || losing_reference || close_points_wanted || facts.view_change > 1) return KeyframeNeed::kMap;
  const bool looked_just_now = facts.frames_since_last < config.movable_interval_frames;
  if (facts.since_last_s < longest - kJitter || looked_just_now) return KeyframeNeed::kNone;
  return scarce ? KeyframeNeed::kMap : KeyframeNeed::kLook;
}

}  // namespace rds::tracker
