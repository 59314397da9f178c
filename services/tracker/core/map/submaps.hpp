// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>

namespace rds::tracker {

using SubmapId = std::uint32_t;

/// Which keyframes stand in the map, and which in a submap: a map of its own that begins where a lost camera
/// cannot find itself, in a frame of its own, until it is recognised where it lies in an older one. All of
/// them together are an atlas.
/// Source: Campos et al. 2021 (ORB-SLAM3), §VI. Deviation: all keyframes and points stay in one container, as
/// nothing but these numbers tells them apart.
class Submaps {
 public:
  using KeyframeId = std::uint64_t;

  /// The map, which began first. Only what is in it has a place in `map`.
  static constexpr SubmapId kMap = 0;

  /// That a keyframe is in.
  [[nodiscard]] SubmapId of(KeyframeId keyframe) const;
  /// Keyframes from this one on are in that submap. @pre no keyframe from this one on is known.
  void go_on(SubmapId submap, KeyframeId from);
  /// The number of the submap that begins next.
  [[nodiscard]] SubmapId next() const { return next_; }
  /// The keyframes of a submap are in an older one from now on.
  void join(SubmapId joined, SubmapId into);
  /// Whether there is none but the map.
  [[nodiscard]] bool is_whole() const;

  /// First keyframe of each row of keyframes that are in one submap, and which it is; before the first row:
  /// the map.
  [[nodiscard]] const std::map<KeyframeId, SubmapId>& rows() const { return rows_; }

 private:
  std::map<KeyframeId, SubmapId> rows_;
  SubmapId next_ = 1;
};

}  // namespace rds::tracker
