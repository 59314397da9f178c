// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "services/tracker/core/pose/found_share.hpp"
#include "services/tracker/core/pose/tracking_context.hpp"

namespace rds::tracker {

/// A pose by points followed from picture to picture.
struct FollowedFrame {
  TrackedFrame frame;
  std::vector<PointId> expected;  // points that were looked for
};

/// Estimates poses from map points that are followed by their patches, without extracting features.
/// Source: Forster, Pizzoli & Scaramuzza 2014 (SVO), §IV.
class PointFollower {
 public:
  /// @param points  to follow.
  PointFollower(int points, Executor executor) : points_(points), executor_(std::move(executor)) {}

  /// camera_from_map by sparse image alignment with the last frame; the prediction where it shows too few
  /// points.
  [[nodiscard]] Pose align(const TrackingContext& context, const LastFrame& last) const;
  /// The search for the local map's points around where this pose projects them.
  [[nodiscard]] PointSearch search(const TrackingContext& context, const Pose& camera_from_map) const;
  /// The better supported of the poses around the guess and, if that has too large an innovation, around the
  /// alignment. @return nullopt where too few points agree.
  std::optional<FollowedFrame> estimate(TrackingContext& context) const;
  /// The pose around another guess. @return nullopt where too few points agree.
  [[nodiscard]] std::optional<FollowedFrame> follow(const TrackingContext& context, const Pose& guess) const;
  /// Counts what was expected and found in the map's points, and the share found in the frame.
  void count_found(SlamMap& map, const std::vector<PointId>& expected, TrackedFrame& frame);
  /// True if that support cannot come from something that moves.
  [[nodiscard]] bool is_sure(double support) const;
  FoundShare& found_share() { return found_share_; }

 private:
  [[nodiscard]] std::optional<FollowedFrame> follow(const TrackingContext& context, PointSearch& search,
                                                    const Pose& guess) const;

  int points_;
  Executor executor_;
  FoundShare found_share_;
};

}  // namespace rds::tracker
