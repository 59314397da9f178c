// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "services/tracker/core/prediction/tracked_object.hpp"

namespace rds::tracker::prediction {

/// How objects are followed from key frame to key frame. ObjectPredictor checks what goes in.
class ObjectTracking {
 public:
  virtual ~ObjectTracking() = default;
  /// @param stamp_ns  later than at the call before. @param observations  valid boxes without duplicates.
  /// @param view  of the key frame; nullptr if it is not known.
  virtual void update(std::int64_t stamp_ns, std::span<const ObjectObservation> observations,
                      const KeyframeView* view) = 0;
  /// @param stamp_ns  not earlier than at the latest update. `movable` is left to the caller.
  [[nodiscard]] virtual std::vector<PredictedObject> predict(std::int64_t stamp_ns) const = 0;
  /// The map's coordinates have changed: new_from_old * point_in_old_map = point_in_map.
  virtual void move_map(const geometry::Pose& new_from_old) = 0;
  virtual void reset() = 0;
};

/// Seconds from one stamp to another.
inline double seconds_between(std::int64_t from_ns, std::int64_t to_ns) {
  return static_cast<double>(to_ns - from_ns) * 1e-9;
}

}  // namespace rds::tracker::prediction
