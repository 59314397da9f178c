// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>

#include "services/tracker/core/feature.hpp"
#include "services/tracker/core/keypoint_spread.hpp"
#include "services/tracker/core/tracker_config.hpp"

namespace rds::tracker {

/// Extracts ORB features that cover the picture evenly.
///
/// Per pyramid level: FAST corners with a lower threshold where a cell shows none, spread by a quadtree,
/// orientation from the intensity centroid (Rosin), steered BRIEF descriptor (OpenCV's). Buffers are kept
/// between pictures. Deterministic. Source: Rublee et al. 2011; Mur-Artal & Tardós 2017, §III.
class OrbExtractor {
 public:
  using MovableTest = std::function<bool(const Eigen::Vector2f& image_px)>;

  explicit OrbExtractor(const ExtractionConfig& config);

  /// @param gray       CV_8UC1 of any size; pictures too small for a patch give no feature.
  /// @param is_movable  if given: tells by place in the picture what lies on a movable object. Such features
  /// are marked and cost nothing of the budget, so that the static rest still gets all of it. They are for
  /// show only, without angle and descriptor, unless a level shows too few static features: then they may
  /// match, for the map they are compared with holds static points only (never starve, as SG-SLAM does).
  /// @param features   overwritten: px and image_px both as seen in the picture, no depth; level by level.
  void extract(const cv::Mat& gray, const MovableTest& is_movable, std::vector<Feature>& features);

 private:
  void build_pyramid(const cv::Mat& gray);
  void find_corners(int level, const MovableTest& is_movable);
  void detect(int level, const cv::Rect& place, int threshold, const MovableTest& is_movable);
  void add_movable(int level, std::size_t quota, std::vector<Feature>& features);
  [[nodiscard]] Feature feature_at(int level, const Corner& corner) const;
  void describe(int level, const std::vector<Corner>& corners, bool movable, std::vector<Feature>& features);
  [[nodiscard]] float orientation(const cv::Mat& image, int x, int y) const;

  ExtractionConfig config_;
  std::vector<int> quota_;             // features per level
  std::vector<int> patch_half_width_;  // of the round patch, by row offset
  std::vector<cv::Mat> pyramid_;
  std::vector<cv::KeyPoint> keypoints_;
  std::vector<Corner> corners_;
  std::vector<Corner> movable_corners_;
  std::vector<int> corners_in_cell_;
  cv::Mat descriptors_;
  cv::Ptr<cv::ORB> orb_;
};

}  // namespace rds::tracker
