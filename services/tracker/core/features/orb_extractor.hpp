// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "services/tracker/core/features/orb_level.hpp"
#include "services/tracker/core/features/run_parts.hpp"

namespace rds::tracker {

/// Extracts ORB features that cover the picture evenly.
///
/// Per pyramid level: FAST corners with a lower threshold where a cell shows none, spread by a quadtree,
/// orientation from the intensity centroid (Rosin), steered BRIEF descriptor (OpenCV's). Buffers are kept
/// between pictures. Deterministic, however levels are run. Source: Rublee et al. 2011; Mur-Artal & Tardós
/// 2017, §III.
class OrbExtractor {
 public:
  /// @param run_parts  runs the levels.
  explicit OrbExtractor(const ExtractionConfig& config, RunParts run_parts = run_in_turn);

  /// @param gray       CV_8UC1 of any size; pictures too small for a patch give no feature.
  /// @param is_movable  if given: tells by place in the picture what lies on a movable object. Such features
  /// are marked and cost nothing of the budget, so that the static rest still gets all of it. They are for
  /// show only, without angle and descriptor, unless a level shows too few static features: then they may
  /// match, for the map they are compared with holds static points only (never starve, as SG-SLAM does).
  /// @param features   overwritten: px and image_px both as seen in the picture, no depth; level by level.
  void extract(const cv::Mat& gray, const MovableTest& is_movable, std::vector<Feature>& features);

 private:
  void build_pyramid(const cv::Mat& gray);

  ExtractionConfig config_;
  RunParts run_parts_;
  std::vector<cv::Mat> pyramid_;
  std::vector<OrbLevel> levels_;
  std::vector<std::vector<Feature>> features_;  // by level
};

}  // namespace rds::tracker
