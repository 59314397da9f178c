// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "services/tracker/core/features/feature_extractor.hpp"
#include "services/tracker/core/pose/found_share.hpp"
#include "services/tracker/core/pose/tracking_context.hpp"

namespace rds::tracker {

/// Estimates poses from features: extracts them, matches them with the last frame, the reference keyframe and
/// the local map. Owns the last frame and the reference keyframe.
/// Source: Mur-Artal et al. 2015, §V.
class FeatureTracker {
 public:
  /// Window factors of refine(): after a good prediction, and after a weak one.
  static constexpr double kUsualWindow = 3;
  static constexpr double kLostWindow = 6;

  explicit FeatureTracker(std::unique_ptr<FeatureExtractor> extractor) : extractor_(std::move(extractor)) {}

  /// The picture's features, without matches.
  void extract(const TrackingContext& context, TrackedFrame& frame);
  /// Pose from the last frame or, where that gives fewer than kSureInliers, from a keyframe, if that gives
  /// more; refined with the local map. @return inliers.
  int track(const TrackingContext& context, TrackedFrame& frame);
  /// Matches the local map around the frame's matches, whose reference keyframe becomes that of the tracker.
  /// @param window_factor  as match_points(). @return inliers; 0 where there is no local map.
  int refine(const TrackingContext& context, TrackedFrame& frame, double window_factor);
  /// Matches of a frame whose pose is given.
  void associate(const TrackingContext& context, TrackedFrame& frame);
  /// The last frame's points that are still there, and those of the map around them.
  LocalMap local_map_of_last(const TrackingContext& context);
  /// The points of the reference keyframe and of all that share points with it.
  [[nodiscard]] LocalMap local_map_around(const TrackingContext& context) const;

  /// The keyframe that shares most map points with the camera's view; kNoId before the first.
  [[nodiscard]] KeyframeId reference() const { return reference_; }
  void set_reference(KeyframeId keyframe) { reference_ = keyframe; }
  /// A keyframe that was made of the newest frame.
  void set_newest_keyframe(KeyframeId keyframe) { reference_ = newest_keyframe_ = keyframe; }
  [[nodiscard]] const std::optional<LastFrame>& last() const { return last_; }
  void set_last(LastFrame&& last) { last_ = std::move(last); }
  /// Points of the map were fused: each goes to the one that took its place.
  void replace_points(const std::map<PointId, PointId>& replaced);
  FoundShare& found_share() { return found_share_; }

 private:
  bool estimate_from_last_frame(const TrackingContext& context, TrackedFrame& frame) const;
  bool estimate_from_keyframe(const TrackingContext& context, TrackedFrame& frame) const;

  std::unique_ptr<FeatureExtractor> extractor_;
  std::optional<LastFrame> last_;
  KeyframeId reference_ = kNoId;
  KeyframeId newest_keyframe_ = kNoId;
  FoundShare found_share_;
  std::uint64_t mark_ = 0;  // of the newest local map
};

/// Takes corners near followed points for them: the corner gets the point, and stands where the point was
/// found.
void adopt_followed_points(const TrackingContext& context, const TrackedFrame& followed, TrackedFrame& frame);

}  // namespace rds::tracker
