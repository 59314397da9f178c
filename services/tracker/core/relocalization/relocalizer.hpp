// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>

#include "common/vision/place_index.hpp"
#include "services/tracker/core/pose/tracking_context.hpp"
#include "services/tracker/core/relocalization/found_keyframe.hpp"

namespace rds::tracker {

/// Where somebody says that the camera is, in a level map: over the ground, and which way it looks.
struct SoughtPlace {
  Pose map_from_camera = Pose::Identity();
  double radius_m = 1;
  double max_angle_rad = 0.8;

  /// True of a camera that stands and looks so. Of one that looks steeply up or down only the place counts.
  [[nodiscard]] bool contains(const Pose& map_from_other) const;
};

/// Localises a frame without a usable motion prediction: candidates by appearance, PnP with RANSAC,
/// refinement, then a wider search for the points of the keyframe and of its covisible keyframes. What is
/// found by one plane alone is not believed: patterns of walls and floors repeat. Source: Mur-Artal et al.
/// 2015, §V-C.
class Relocalizer {
 public:
  /// Inliers that a pose found without a prediction needs.
  static constexpr int kMinInliers = 50;

  /// Which keyframes the camera may be near.
  using Where = std::function<bool(const Keyframe&)>;

  /// Tries those of the keyframes that look most like the frame.
  /// @return true if at least kMinInliers map points agree that do not all lie in one plane; then
  /// frame.points and camera_from_map hold the result.
  bool localize(const TrackingContext& context, const Where& where, TrackedFrame& frame) const;
  /// Looks for the place that a keyframe shows among the keyframes of other submaps.
  /// @return nullopt if fewer than kMinInliers map points agree, or all of them lie in one plane.
  std::optional<FoundKeyframe> find_in_others(SlamMap& map, const PoseSettings& settings,
                                              KeyframeId keyframe) const;
  /// Finds the points of a keyframe and of its covisible keyframes in a frame whose pose is known to a few
  /// centimetres and degrees: frame.points and camera_from_map hold the result.
  static void localize_near(const TrackingContext& context, const Keyframe& keyframe, TrackedFrame& frame);

  /// A keyframe to find the camera by. It is indexed by the next index_pending(), one at a time.
  void add(KeyframeId keyframe) { pending_ = keyframe; }
  void index_pending(const SlamMap& map);
  void index_all(const SlamMap& map);
  void remove(KeyframeId keyframe) { places_.remove(keyframe); }
  [[nodiscard]] std::size_t places() const { return places_.size() + (pending_ != kNoId ? 1 : 0); }

 private:
  static bool localize_against(const TrackingContext& context, KeyframeId keyframe, TrackedFrame& frame);

  vision::PlaceIndex places_;
  KeyframeId pending_ = kNoId;
};

/// Descriptors of the features that are not movable, N×32 CV_8U.
cv::Mat static_descriptors(const FeatureSet& features);

}  // namespace rds::tracker
