// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <optional>

#include "services/tracker/core/config/tracker_config.hpp"
#include "services/tracker/core/level/up_direction.hpp"
#include "services/tracker/core/mapping/keyframe_selector.hpp"
#include "services/tracker/core/pose/depth_aligner.hpp"
#include "services/tracker/core/pose/feature_tracker.hpp"
#include "services/tracker/core/pose/point_follower.hpp"
#include "services/tracker/core/relocalization/relocalizer.hpp"
#include "services/tracker/core/tracking_types.hpp"

namespace rds::tracker {

/// A frame's pose and how it was found.
struct PoseEstimate {
  TrackedFrame frame;
  State state = State::kLost;
  bool is_followed = false;                     // by points; else matched by features
  bool begins_map = false;                      // or a submap: the frame has to become its first keyframe
  std::shared_ptr<const FeatureSet> extracted;  // of a followed frame, if its features were looked at, too
  std::int64_t extract_us = 0;
  std::optional<UpDirection> up = std::nullopt;  // that a map begins with, by its first picture
};

/// Finds the pose of a frame: chooses between the estimates of point following, feature tracking, depth
/// alignment and relocalisation.
class Localizer {
 public:
  /// @param poses_are_given  no pose is estimated: context.guess is the pose.
  Localizer(const TrackerConfig& config, const Executor& executor, Stopwatch now_us, bool poses_are_given);

  [[nodiscard]] const PoseSettings& settings() const { return settings_; }
  /// Makes the image pyramid, and guesses the pose by sparse image alignment or by the motion model.
  /// @param before  state of the frame before; this and all below.
  void guess(TrackingContext& context, State before) const;
  /// Fills in the part of the map that the frame should see, if it is where the last one was.
  void select_local_map(TrackingContext& context);
  /// Looks for map points around the guess, where they can be followed, until enough is set.
  void search_early(TrackingContext& context, State before, const std::atomic<bool>& enough) const;
  /// The pose: by points where that is sure, else by features, by depth, by relocalisation.
  PoseEstimate localize(TrackingContext& context, State before, const KeyframeSelector& keyframes);
  /// Begins a submap with a frame that was not found, in a frame of its own.
  /// @return false if it shows too little.
  bool begin_submap(const TrackingContext& context, PoseEstimate& lost) const;
  /// True of a frame that shows enough for the first keyframe of a map.
  [[nodiscard]] bool can_begin_map(const TrackedFrame& frame) const;
  /// Matches features in a followed frame that is to become a keyframe, near its pose.
  /// @return false if too few match: then it stays as it is.
  bool match_features(const TrackingContext& context, PoseEstimate& estimate);

  /// Which way is up in the camera's frame, as an accelerometer says; a map that begins is level by it.
  void set_up(const std::optional<Eigen::Vector3d>& up_in_camera) { measured_up_ = up_in_camera; }
  /// A lost camera is looked for around this place, too, until it is found.
  void seek(const SoughtPlace& place) { sought_ = place; }

  /// True if the share of the expected points that is found has dropped since the last keyframe.
  [[nodiscard]] bool scene_changed();
  /// A keyframe was made.
  void begin_interval();
  /// Frames of a map to keep following points in need their image pyramid.
  [[nodiscard]] bool follows_points() const { return follows_points_; }

  FeatureTracker& features() { return features_; }
  [[nodiscard]] const FeatureTracker& features() const { return features_; }
  DepthAligner& depth_aligner() { return depth_aligner_; }
  Relocalizer& relocalizer() { return relocalizer_; }
  [[nodiscard]] const Relocalizer& relocalizer() const { return relocalizer_; }

 private:
  void begin_map(const TrackingContext& context, PoseEstimate& first) const;
  PoseEstimate match(const TrackingContext& context, State before, const KeyframeSelector& keyframes);
  State estimate(const TrackingContext& context, State before, const KeyframeSelector& keyframes,
                 PoseEstimate& found);
  bool follow_expected(const TrackingContext& context, const Pose& expected, PoseEstimate& lost);
  [[nodiscard]] bool is_in_unproven_submap(const SlamMap& map) const;
  bool relocalize(const TrackingContext& context, TrackedFrame& frame);
  bool find_carried(const TrackingContext& context, const KeyframeSelector& keyframes, TrackedFrame& frame);
  bool find_near(const TrackingContext& context, const Pose& by_depth, const KeyframeSelector& keyframes,
                 TrackedFrame& frame);
  std::int64_t extract(const TrackingContext& context, TrackedFrame& frame);

  TrackerConfig config_;
  PoseSettings settings_;
  Stopwatch now_us_;
  bool poses_are_given_;
  bool follows_points_;
  PointFollower follower_;
  FeatureTracker features_;
  DepthAligner depth_aligner_;
  Relocalizer relocalizer_;
  std::optional<Eigen::Vector3d> measured_up_;
  std::optional<SoughtPlace> sought_;
  std::int64_t weak_since_ns_ = 0;  // time of the first of the weak frames in a row
};

}  // namespace rds::tracker
