// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <optional>
#include <span>
#include <vector>

#include "common/image/rgbd_frame.hpp"
#include "services/tracker/core/features/executor.hpp"
#include "services/tracker/core/features/image_pyramid.hpp"
#include "services/tracker/core/pose/association.hpp"
#include "services/tracker/core/removal/movable_mask.hpp"

namespace rds::tracker {

/// A picture in which map points are followed.
struct FollowingView {
  const image::RgbdFrame& picture;
  const ImagePyramid& images;               // of the picture
  Pose camera_from_map = Pose::Identity();  // near to the truth: features are a few pixels off at most
  ShutterMotion motion;
};

/// Map points found in a picture without extracting features.
struct FollowedPoints {
  std::vector<Feature> features;  // image_px; level, angle and descriptor as in the map. Not matchable.
  std::vector<PointId> points;    // per feature; kNoId: not looked for, because something movable is there
  std::vector<PointId> looked_for;
};

/// The observation from the nearest place whose picture is kept; null if there is none, as in a saved map.
const Observation* nearest_view(const SlamMap& map, const MapPoint& point,
                                const Eigen::Vector3d& camera_in_map);

/// Finds map points in a picture by the patch around the feature of the keyframe that saw them from nearest.
///
/// The most observed points of every part of the picture come first, until enough are found. A point
/// whose patch looks otherwise there is hidden or gone and is left out. What it is made of has to outlive it,
/// unchanged.
class PointSearch {
 public:
  /// @param wanted  points to find.
  PointSearch(const SlamMap& map, std::span<const PointId> points, const FollowingView& view,
              const ObservationModel& model, const ScalePyramid& pyramid, int wanted);

  /// Looks for the points that come first, before it is known what is movable. What find() says does not
  /// depend on it.
  /// @param enough  set, by another thread, when the result is waited for.
  void prefetch(const std::atomic<bool>& enough);
  /// @param movable  where static points are hidden.
  FollowedPoints find(const MovableMask& movable, const Executor& executor = execute_serially);

 private:
  struct Expected {  // a map point that the picture should show
    const MapPoint* point = nullptr;
    Eigen::Vector2f image_px = Eigen::Vector2f::Zero();
    int level = 0;
    bool hidden = false;  // by something movable
    bool looked_for = false;
    std::optional<Feature> found;
  };

  void expect(std::span<const PointId> points, const ObservationModel& model);
  void spread();
  void hide(const MovableMask& movable);
  void align_once(Expected& expected) const;
  [[nodiscard]] std::optional<Feature> align(const Expected& expected) const;
  [[nodiscard]] std::size_t batch_end(std::size_t begin, std::size_t wanted) const;

  const SlamMap& map_;
  FollowingView view_;
  const ScalePyramid& pyramid_;
  std::size_t wanted_;
  Eigen::Vector3d camera_in_map_;
  std::vector<Expected> expected_;  // in the order in which they are looked for
};

}  // namespace rds::tracker
