// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "services/tracker/core/features/feature_extractor.hpp"
#include "services/tracker/core/features/orb_level.hpp"

namespace rds::tracker {

/// Extracts ORB features that cover the picture evenly.
///
/// Per pyramid level: FAST corners with a lower threshold where a cell shows none, spread by a quadtree,
/// orientation from the intensity centroid (Rosin), steered BRIEF descriptor (OpenCV's). Buffers are kept
/// between pictures. Deterministic, however levels are run. Source: Rublee et al. 2011; Mur-Artal & Tardós
/// 2017, §III.
class OrbExtractor final : public FeatureExtractor {
 public:
  /// @param executor  runs the levels.
  explicit OrbExtractor(const ExtractionConfig& config, Executor executor = execute_serially);

  void extract(const cv::Mat& gray, const MovableTest& is_movable, std::vector<Feature>& features) override;

 private:
  void build_pyramid(const cv::Mat& gray);

  ExtractionConfig config_;
  Executor executor_;
  std::vector<cv::Mat> pyramid_;
  std::vector<OrbLevel> levels_;
  std::vector<std::vector<Feature>> features_;  // by level
};

}  // namespace rds::tracker
