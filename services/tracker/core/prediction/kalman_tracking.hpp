// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "services/tracker/core/prediction/object_filter.hpp"
#include "services/tracker/core/prediction/object_tracking.hpp"

namespace rds::tracker::prediction {

/// One ObjectFilter per object; detections find their object by distance and overlap in 3-D, and by label.
///
/// Our alternative to Algorithm 1: it has one motion model per object instead of three, keeps boxes aligned
/// with the camera instead of the map, and knows its uncertainty: a missed object's box grows until it is
/// forgotten.
class KalmanTracking : public ObjectTracking {
 public:
  /// The most that a box grows by its uncertainty, per side [m].
  static constexpr double kMaxGrowthM = 0.2;

  void update(std::int64_t stamp_ns, std::span<const ObjectObservation> observations,
              const KeyframeView* view) override;
  [[nodiscard]] std::vector<PredictedObject> predict(std::int64_t stamp_ns) const override;
  void move_map(const geometry::Pose& new_from_old) override;
  void reset() override { tracks_.clear(); }

 private:
  struct Track {
    std::uint64_t id = 0;
    std::string label;
    float score = 0;
    std::int64_t seen_ns = 0;
    int misses = 0;  // key frames since then that should have shown it
    ObjectFilter filter;
  };

  void count_misses(std::span<const ObjectObservation> observations, const KeyframeView* view);
  void move_to(std::int64_t stamp_ns);
  /// For each observation the index of its track, -1 if it has none.
  [[nodiscard]] std::vector<std::ptrdiff_t> match(std::span<const ObjectObservation> observations) const;
  /// From 0 (same place) to 2; nothing if the observation cannot be of this track.
  [[nodiscard]] static std::optional<double> cost(const Track& track, const ObjectObservation& observation);
  [[nodiscard]] PredictedObject describe(const Track& track, std::int64_t stamp_ns) const;

  std::vector<Track> tracks_;  // oldest first
  std::int64_t state_ns_ = 0;  // time of all filters
  std::uint64_t last_id_ = 0;
};

}  // namespace rds::tracker::prediction
