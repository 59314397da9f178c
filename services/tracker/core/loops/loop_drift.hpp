// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/geometry/loop_match.hpp"
#include "services/tracker/core/map/slam_map.hpp"

namespace rds::tracker {

/// How far a loop says that the map has drifted.
struct LoopDrift {
  double moved_m = 0;     // from where the map has the later keyframe to where the loop has it
  double way_m = 0;       // between the two keyframes, over covisible ones: drift adds up along it
  double gap_s = 0;       // of the way, in which the camera was lost
  double turned_rad = 0;  // from how the map has the later keyframe to how the loop has it

  /// Log-odds that the place is the same one and not one that looks alike, by the drift alone.
  ///
  ///   log( (1 − ε) · A / (2πσ²) · exp(−d² / 2σ² − φ² / 2ρ²) + ε ),
  ///   σ = 0.1 m + 0.02 · way + 1 m/s · gap,  ρ = 0.01 rad + 0.003 rad/m · way + 1 rad/s · gap
  ///
  /// The tracker drifts (d, φ) by a share of its way, or in one case of so many (ε) it has been led astray; a
  /// lost camera walks on; places that look alike stand anywhere on a floor of area A, turned as they are.
  [[nodiscard]] double log_odds() const;
  /// The moved_m at which log_odds() is 0 for who has not turned; nullopt where it is less for all, as the
  /// camera was lost for so long that nothing is known.
  [[nodiscard]] std::optional<double> reach_m() const;
};

/// Where a submap begins, and the last keyframe of an older one before that.
struct SubmapBorder {
  KeyframeId before = kNoId;
  KeyframeId first = kNoId;
  double gap_s = 0;  // between them
};
/// @return nullopt where the records of either are not kept.
std::optional<SubmapBorder> border_of(const KeyframeRecords& records, SubmapId older, SubmapId younger);

/// Of keyframes in one submap or in two. Of two, moved_m is from the last keyframe of the older one, before
/// the camera was lost, to where the loop has the first of the younger one.
/// @param loop  whose keyframes the map knows.
/// @return nullopt where no way over covisible keyframes joins the two, or the camera was lost for so long
/// that nothing is known of how they stand to each other.
std::optional<LoopDrift> drift_of(const SlamMap& map, const geometry::LoopMatch& loop);

}  // namespace rds::tracker
