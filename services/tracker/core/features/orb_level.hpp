// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>

#include "services/tracker/core/features/feature_extractor.hpp"
#include "services/tracker/core/features/keypoint_spread.hpp"

namespace rds::tracker {

/// Extracts the ORB features of one pyramid level; its buffers are kept between pictures.
class OrbLevel {
 public:
  /// @param quota  features wanted.
  OrbLevel(const ExtractionConfig& config, int level, std::size_t quota);

  /// @param image    of this level. @param picture  size of the picture, level 0.
  /// @param features overwritten.
  void extract(const cv::Mat& image, cv::Size picture, const MovableTest& is_movable,
               std::vector<Feature>& features);

 private:
  void find_corners(const MovableTest& is_movable);
  void detect(const cv::Rect& place, int threshold, const MovableTest& is_movable);
  void add_movable(std::vector<Feature>& features);
  [[nodiscard]] Feature feature_at(const Corner& corner) const;
  void describe(const std::vector<Corner>& corners, bool movable, std::vector<Feature>& features);
  [[nodiscard]] float orientation(int x, int y) const;

  ExtractionConfig config_;
  int level_;
  std::size_t quota_;
  std::vector<int> patch_half_width_;  // of the round patch, by row offset
  cv::Mat image_;
  cv::Size picture_;
  std::vector<cv::KeyPoint> keypoints_;
  std::vector<Corner> corners_;
  std::vector<Corner> movable_corners_;
  std::vector<int> corners_in_cell_;
  cv::Mat descriptors_;
  cv::Ptr<cv::ORB> orb_;
};

}  // namespace rds::tracker
