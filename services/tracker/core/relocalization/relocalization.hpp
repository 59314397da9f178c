// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "services/tracker/core/pose/association.hpp"
#include "services/tracker/core/relocalization/relocalization_config.hpp"

namespace rds::tracker {

/// What relocalisation needs to know.
struct RelocalizationTools {
  const ObservationModel& model;
  const ScalePyramid& pyramid;
  const MatchingConfig& matching;
  const PoseOptimizationConfig& pose;
  const RelocalizationConfig& config;
};

/// Localises a frame against one keyframe without knowing where it is: matches by appearance, PnP with
/// RANSAC, refinement, then a wider search for the points of the keyframe and of its covisible keyframes.
///
/// @return true if at least config.min_inliers map points agree; then frame.points and camera_from_map hold
/// the result.
/// Source: Mur-Artal et al. 2015, §V-C.
bool relocalize_against(SlamMap& map, KeyframeId keyframe, const RelocalizationTools& tools,
                        TrackedFrame& frame);

/// Finds the points of a keyframe and of its covisible keyframes in a frame whose pose is known to a few
/// centimetres and degrees: frame.points and camera_from_map hold the result.
void localize_around(SlamMap& map, const Keyframe& keyframe, const RelocalizationTools& tools,
                     TrackedFrame& frame);

/// Descriptors of the features that are not movable, N×32 CV_8U.
cv::Mat static_descriptors(const FeatureSet& features);

}  // namespace rds::tracker
