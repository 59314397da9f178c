// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "services/tracker/core/prediction/image_projection.hpp"
#include "services/tracker/core/prediction/object_predictor.hpp"

namespace rds::tracker {

/// A tracked object as it stands in one frame.
struct ImageObject {
  prediction::PredictedObject object;
  geometry::Box2 box;
};

/// What the tracking process knows about objects: from boxes of keyframes to boxes and regions of any frame.
class MovableObjects {
 public:
  using Observations = std::span<const prediction::ObjectObservation>;

  explicit MovableObjects(const prediction::PredictionConfig& config) : predictor_(config) {}

  /// @param view  of the keyframe, if it is known.
  void observe(std::int64_t stamp_ns, Observations observations,
               const std::optional<prediction::KeyframeView>& view) {
    predictor_.update(stamp_ns, observations, view);
    ++observed_;
  }
  /// Keyframes whose boxes were observed.
  [[nodiscard]] std::uint64_t observed() const { return observed_; }
  void move_map(const geometry::Pose& new_from_old) { predictor_.move_map(new_from_old); }
  void reset() { predictor_.reset(); }

  /// Where the objects are expected in a frame; without those outside the picture.
  [[nodiscard]] std::vector<ImageObject> in_image(std::int64_t stamp_ns,
                                                  const geometry::Pose& camera_from_map,
                                                  const geometry::CameraModel& camera) const;

  /// Regions whose features are not to be trusted in a frame: of the movable ones among the objects.
  [[nodiscard]] std::vector<segmentation::ObjectRegion> regions(std::int64_t stamp_ns,
                                                   const geometry::Pose& camera_from_map,
                                                   const geometry::CameraModel& camera) const;

  /// The same for the boxes of a keyframe at its own pose.
  [[nodiscard]] std::vector<segmentation::ObjectRegion> regions_of(Observations observations,
                                                      const geometry::Pose& camera_from_map,
                                                      const geometry::CameraModel& camera) const;

 private:
  prediction::ObjectPredictor predictor_;
  std::uint64_t observed_ = 0;
};

}  // namespace rds::tracker
