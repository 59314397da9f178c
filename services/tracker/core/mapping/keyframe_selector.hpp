// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <optional>

#include "services/tracker/core/mapping/keyframe_policy.hpp"
#include "services/tracker/core/pose/tracking_context.hpp"

namespace rds::tracker {

/// Decides which frames become keyframes: states what keyframe_need() asks for, from the frame and from the
/// keyframes there are.
class KeyframeSelector {
 public:
  /// A keyframe and how far its view is, as view_change() says.
  struct NearestView {
    KeyframeId keyframe = kNoId;
    double change = std::numeric_limits<double>::infinity();
  };
  /// A frame with a pose.
  struct Candidate {
    const TrackingContext& context;
    const TrackedFrame& frame;
    KeyframeId reference = kNoId;
    bool scene_changed = false;  // faster than the view
  };

  explicit KeyframeSelector(const KeyframeConfig& config) : config_(config) {}
  /// From the next frame on.
  void set(const KeyframeConfig& config) { config_ = config; }

  /// The keyframe with the view nearest to the frame's: the newest one, or one of those covisible with the
  /// reference that are older than config.known_after_s. (While a place is new, every turn of the camera
  /// makes a keyframe: from views that come back bundle adjustment learns drift and readout time.)
  [[nodiscard]] NearestView nearest_view(const SlamMap& map, const TrackedFrame& frame,
                                         KeyframeId reference) const;
  /// Of a frame that is matched by features.
  [[nodiscard]] KeyframeNeed need_of_matched(const Candidate& candidate) const;
  /// Of a frame that is followed by points: here the covered part of the picture counts instead of points.
  KeyframeNeed need_of_followed(const Candidate& candidate);

  void begin_frame() { ++frames_since_last_; }
  /// The frame has become a keyframe of the map.
  /// kNoId before the first.
  [[nodiscard]] KeyframeId newest_in_map() const { return newest_in_map_; }
  void note_in_map(KeyframeId keyframe, std::int64_t time_ns);
  /// The frame has become a keyframe for others only.
  void note_not_in_map(std::int64_t time_ns);

 private:
  [[nodiscard]] KeyframeFacts facts(const Candidate& candidate, double view_change) const;

  KeyframeConfig config_;
  KeyframeId newest_in_map_ = kNoId;
  std::optional<std::int64_t> last_ns_;  // time of the last keyframe
  int frames_since_last_ = 0;
  KeyframeId followed_view_ = kNoId;  // nearest_view() of the last followed frame
  int covered_at_view_ = 0;  // cells of the picture with followed points when that became the nearest
};

}  // namespace rds::tracker
