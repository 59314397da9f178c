// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/geometry/box.hpp"
#include "services/tracker/core/prediction/sort/box_filter.hpp"

namespace rds::tracker::prediction {

struct SortConfig {
  double min_iou = 0.3;  // pairs that overlap less are no match
  int min_hits = 3;      // consecutive updates before a track is reported (after the first min_hits updates)
  double max_age = 1;    // frame periods that a track lives without a match

  bool operator==(const SortConfig&) const = default;
};

/// Tracks boxes in a plane: SORT (Bewley et al. 2016), Kalman filter and assignment on IoU.
///
/// Deviation: time steps may differ (BoxFilter). With steps of 1 and the defaults it is the published
/// tracker.
class Sort {
 public:
  struct Track {
    std::uint64_t id = 0;  // from 1
    BoxFilter filter;
    double age = 0;      // frame periods since the last match
    int hit_streak = 0;  // updates in a row with a match, the first not counted
  };

  explicit Sort(const SortConfig& config) : config_(config) {}

  /// Predicts all tracks by `frames` > 0 frame periods, matches, corrects, starts and forgets tracks.
  ///
  /// @param boxes  N boxes with area > 0.
  /// @return id of the track that each of the N boxes belongs to now.
  std::vector<std::uint64_t> update(double frames, std::span<const geometry::Box2> boxes);

  /// All living tracks, oldest first.
  [[nodiscard]] const std::vector<Track>& tracks() const { return tracks_; }
  /// Whether SORT reports the track: matched in the latest update and seen often enough.
  [[nodiscard]] bool is_reported(const Track& track) const;

 private:
  void predict(double frames);
  /// For each box the index of its track, -1 if it has none.
  [[nodiscard]] std::vector<std::ptrdiff_t> match(std::span<const geometry::Box2> boxes) const;

  SortConfig config_;
  std::vector<Track> tracks_;
  std::uint64_t last_id_ = 0;
  int updates_ = 0;
};

}  // namespace rds::tracker::prediction
