// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include <opencv2/core.hpp>

#include "services/tracker/core/config/tracker_config.hpp"
#include "services/tracker/core/features/executor.hpp"
#include "services/tracker/core/features/feature.hpp"

namespace rds::tracker {

/// Tells by place in the picture what lies on a movable object. May be called by several threads.
using MovableTest = std::function<bool(const Eigen::Vector2f& image_px)>;

/// Finds features in a picture. Same pictures, same features.
class FeatureExtractor {
 public:
  FeatureExtractor() = default;
  FeatureExtractor(const FeatureExtractor&) = delete;
  FeatureExtractor& operator=(const FeatureExtractor&) = delete;
  virtual ~FeatureExtractor() = default;

  /// @param gray       CV_8UC1 of any size; pictures too small for a patch give no feature.
  /// @param is_movable  if given: features there are marked and cost nothing of the budget, so that the
  /// static rest still gets all of it. They are for pictures only, without angle and descriptor, unless a
  /// level shows too few static features: then they may match, for the map they are compared with holds
  /// static points only (never starve, as SG-SLAM does).
  /// @param features   overwritten: px and image_px both as seen in the picture, no depth; level by level.
  virtual void extract(const cv::Mat& gray, const MovableTest& is_movable,
                       std::vector<Feature>& features) = 0;
};

/// The extractor that the tracker uses. @param executor  runs what is independent.
std::unique_ptr<FeatureExtractor> make_feature_extractor(const ExtractionConfig& config, Executor executor);

}  // namespace rds::tracker
