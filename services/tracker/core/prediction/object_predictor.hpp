// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "services/tracker/core/prediction/object_tracking.hpp"
#include "services/tracker/core/prediction/prediction_config.hpp"
#include "services/tracker/core/prediction/tracked_object.hpp"

namespace rds::tracker::prediction {

/// Tracks the objects of key frames and says where they are in any frame.
///
/// Source: paper §IV-B, prediction(P_w) of eq. (1); `algorithm` chooses Algorithm 1 or a filter in 3-D.
class ObjectPredictor {
 public:
  explicit ObjectPredictor(PredictionConfig config);

  /// Takes all detections of one key frame; an empty list means that nothing is there.
  ///
  /// Boxes that are not finite, empty or absurdly large are ignored, as are duplicates and scores that are
  /// too low; at most kMaxObservations, the best ones, are used.
  /// @param view  of the key frame, if known: boxes that the picture's edge cuts off are then understood.
  /// @return false, without effect, if the stamp is not after that of the latest update.
  bool update(std::int64_t stamp_ns, std::span<const ObjectObservation> observations,
              const std::optional<KeyframeView>& view = std::nullopt);

  /// Objects at a time, by ascending id; nothing ages through asking. Objects of before the latest update do
  /// not move backwards: an earlier time gives their state at the update.
  [[nodiscard]] std::vector<PredictedObject> predict(std::int64_t stamp_ns) const;

  /// Keeps the objects where they are when a loop closure moves the map under them:
  /// new_from_old * point_in_old_map = point_in_map. Algorithm 1 cannot turn its planes and forgets them.
  /// A pose that is not finite is ignored.
  void move_map(const geometry::Pose& new_from_old);

  /// Forgets all objects; ids go on.
  void reset();

  [[nodiscard]] const PredictionConfig& config() const { return config_; }

  static constexpr std::size_t kMaxObservations = 100;

 private:
  PredictionConfig config_;
  std::unique_ptr<ObjectTracking> tracking_;
  std::optional<std::int64_t> latest_ns_;
};

}  // namespace rds::tracker::prediction
