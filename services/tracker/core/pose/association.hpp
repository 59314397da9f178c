// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "services/tracker/core/map/slam_map.hpp"
#include "services/tracker/core/pose/observation_model.hpp"
#include "services/tracker/core/pose/tracked_frame.hpp"

namespace rds::tracker {

/// Bits in which descriptors of one corner differ at most: where it is expected, and where nothing but its
/// appearance speaks for it. (Two corners that look unlike each other differ in 128 on average.)
inline constexpr int kMaxDistanceNearby = 100;
inline constexpr int kMaxDistanceAlone = 50;
/// Matches by appearance that a pose can be found from.
inline constexpr int kMinKeyframeMatches = 15;

/// Where and how a feature is searched.
struct SearchWindow {
  Eigen::Vector2f px = Eigen::Vector2f::Zero();
  float radius_px = 0;
  int min_level = 0;
  int max_level = 0;
  double disparity_px =
      0;  // expected; features whose depth says otherwise by more than the radius do not match
};

/// The free feature in the window whose descriptor is nearest.
///
/// @param taken  per feature: kNoId if free; empty if all are.
/// @param ratio  of best to second-best distance at the same level; 1 switches the test off.
std::optional<std::uint32_t> best_in_window(const FeatureSet& features, std::span<const PointId> taken,
                                            const ObservationModel& model, const Descriptor& descriptor,
                                            const SearchWindow& window, int max_distance, double ratio);

/// Of matches with these differences of feature angle [rad], those in the three fullest of thirty bins.
std::vector<bool> consistent_rotation(std::span<const float> differences);

/// Where and how a view shows a map point.
struct ProjectedPoint {
  Eigen::Vector2d px;
  double distance = 0;     // m
  double depth = 0;        // m
  double view_cosine = 1;  // between the viewing ray and the point's mean viewing direction
  int level = 0;           // where the feature should be
};
/// @return nullopt for a point behind the camera, outside the picture, at a distance from which its feature
/// has none of the pyramid's levels, or seen from more than 60° off its mean viewing direction.
std::optional<ProjectedPoint> project_point(const MapPoint& point, const Pose& camera_from_map,
                                            const Eigen::Vector3d& camera_in_map, const FeatureSet& view,
                                            const ObservationModel& model, const ScalePyramid& pyramid);

/// Finds the last frame's map points again around where `frame.camera_from_map` expects them.
/// @return number of matches; frame.points is overwritten.
int match_last_frame(const SlamMap& map, const TrackedFrame& last, const ObservationModel& model,
                     const ScalePyramid& pyramid, double window_px, TrackedFrame& frame);

/// Matches a keyframe's map points by appearance alone (mutual nearest neighbour, rotation check), with
/// features that are not on movable objects.
/// @return number of matches; frame.points is overwritten.
int match_keyframe(const SlamMap& map, const Keyframe& keyframe, TrackedFrame& frame);

/// What match_points() did.
struct PointMatches {
  int expected = 0;  // points that should show
  int found = 0;     // new matches
};
/// Adds matches of points that the frame does not see yet; counts `visible` of those that should show.
/// @param window_factor  times 2.5 px (seen from its usual direction) or 4 px, times the level's scale.
PointMatches match_points(SlamMap& map, std::span<const PointId> points, const ObservationModel& model,
                          const ScalePyramid& pyramid, double window_factor, TrackedFrame& frame);

/// Weight of a point while something movable is in view: (t / 0.4 s)² of the time t over which frames found
/// it in its place, from 0.02 (it may be on what moves) to 1 (it is static).
double static_weight(const SlamMap& map, const MapPoint& point);

/// Pose from the frame's matches, unless it is given; outliers are removed from frame.points.
/// @return number of inliers.
int optimize_frame(const SlamMap& map, const ObservationModel& model, const ScalePyramid& pyramid,
                   TrackedFrame& frame);

}  // namespace rds::tracker
