// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/features/orb_level.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace rds::tracker {
namespace {

constexpr int kPatchRadius = 15;  // of the orientation's round patch
constexpr int kFastRadius = 3;
constexpr int kBorder = 19;  // the steered descriptor patch reaches this far
constexpr int kPatchSize = 31;
constexpr int kCell = 30;              // px, side of the cells that shall each show a corner
constexpr double kStarvedShare = 0.3;  // of the quota; with fewer static features movable ones may match
constexpr float kRadPerDegree = static_cast<float>(CV_PI / 180);

}  // namespace

OrbLevel::OrbLevel(const ExtractionConfig& config, int level, std::size_t quota)
    : config_(config),
      level_(level),
      quota_(quota),
      orb_(cv::ORB::create(config.features, 1.2F, 1, kBorder - 1, 0, 2, cv::ORB::HARRIS_SCORE, kPatchSize)) {
  for (int dy = -kPatchRadius; dy <= kPatchRadius; ++dy)
    patch_half_width_.push_back(
        static_cast<int>(std::sqrt(kPatchRadius * kPatchRadius - dy * dy + kPatchRadius)));
}

void OrbLevel::extract(const cv::Mat& image, cv::Size picture, const MovableTest& is_movable,
                       std::vector<Feature>& features) {
  features.clear();
  image_ = image;
  picture_ = picture;
  find_corners(is_movable);
  if (!movable_corners_.empty()) add_movable(features);
  describe(spread_evenly(corners_, static_cast<float>(image.cols - 2 * kBorder),
                         static_cast<float>(image.rows - 2 * kBorder), quota_),
           false, features);
}

void OrbLevel::detect(const cv::Rect& place, int threshold, const MovableTest& is_movable) {
  const cv::Rect seen(place.x - kFastRadius, place.y - kFastRadius, place.width + 2 * kFastRadius,
                      place.height + 2 * kFastRadius);
  cv::FAST(image_(seen), keypoints_, threshold, true);
  for (const cv::KeyPoint& k : keypoints_) {
    const Corner corner{k.pt.x + static_cast<float>(seen.x - kBorder),
                        k.pt.y + static_cast<float>(seen.y - kBorder), k.response};
    const bool movable = is_movable && is_movable(feature_at(corner).image_px);
    (movable ? movable_corners_ : corners_).push_back(corner);
  }
}

void OrbLevel::find_corners(const MovableTest& is_movable) {
  corners_.clear();
  movable_corners_.clear();
  const cv::Rect inner(kBorder, kBorder, image_.cols - 2 * kBorder, image_.rows - 2 * kBorder);
  if (inner.width <= 0 || inner.height <= 0) return;
  detect(inner, config_.fast_threshold, is_movable);
  const int columns = (inner.width + kCell - 1) / kCell;
  const int rows = (inner.height + kCell - 1) / kCell;
  corners_in_cell_.assign(static_cast<std::size_t>(columns * rows), 0);
  for (const Corner& c : corners_)
    ++corners_in_cell_[static_cast<std::size_t>(static_cast<int>(c.y) / kCell * columns +
                                                static_cast<int>(c.x) / kCell)];
  for (int i = 0; i < columns * rows; ++i)
    if (corners_in_cell_[static_cast<std::size_t>(i)] == 0)
      detect(cv::Rect(inner.x + i % columns * kCell, inner.y + i / columns * kCell, kCell, kCell) & inner,
             config_.fast_threshold_low, is_movable);
}

float OrbLevel::orientation(int x, int y) const {
  int moment_x = 0;
  int moment_y = 0;
  for (int dy = -kPatchRadius; dy <= kPatchRadius; ++dy) {
    const int half = patch_half_width_[static_cast<std::size_t>(dy + kPatchRadius)];
    const std::uint8_t* row = image_.ptr<std::uint8_t>(y + dy) + x;
    int row_sum = 0;
    for (int dx = -half; dx <= half; ++dx) {
      row_sum += row[dx];
      moment_x += dx * row[dx];
    }
    moment_y += dy * row_sum;
  }
  return cv::fastAtan2(static_cast<float>(moment_y), static_cast<float>(moment_x));
}

void OrbLevel::describe(const std::vector<Corner>& corners, bool movable, std::vector<Feature>& features) {
  keypoints_.clear();
  for (const Corner& c : corners) {
    const float x = c.x + kBorder;
    const float y = c.y + kBorder;
    const float angle = orientation(static_cast<int>(x), static_cast<int>(y));
    keypoints_.emplace_back(x, y, static_cast<float>(kPatchSize), angle, c.score, 0);
  }
  if (keypoints_.empty()) return;
  orb_->compute(image_, keypoints_, descriptors_);
  for (std::size_t i = 0; i < keypoints_.size(); ++i) {
    Feature feature = feature_at(corners[i]);
    feature.movable = movable;
    feature.angle_rad = keypoints_[i].angle * kRadPerDegree;
    std::memcpy(feature.descriptor.data(), descriptors_.ptr(static_cast<int>(i)), feature.descriptor.size());
    features.push_back(feature);
  }
}

Feature OrbLevel::feature_at(const Corner& corner) const {
  // resize() keeps the centres of the corner pixels half a pixel inside, so levels differ by half pixels.
  const float scale_x = static_cast<float>(picture_.width) / static_cast<float>(image_.cols);
  const float scale_y = static_cast<float>(picture_.height) / static_cast<float>(image_.rows);
  Feature feature;
  feature.image_px = {(corner.x + kBorder + 0.5F) * scale_x - 0.5F,
                      (corner.y + kBorder + 0.5F) * scale_y - 0.5F};
  feature.px = feature.image_px;
  feature.level = static_cast<std::uint8_t>(level_);
  return feature;
}

void OrbLevel::add_movable(std::vector<Feature>& features) {
  const std::size_t all = corners_.size() + movable_corners_.size();
  const bool starved = static_cast<double>(corners_.size()) < kStarvedShare * static_cast<double>(quota_);
  // For pictures, as many as the budget would give to this share of the corners.
  const std::size_t wanted = starved ? quota_ - corners_.size() : quota_ * movable_corners_.size() / all;
  const auto chosen = spread_evenly(movable_corners_, static_cast<float>(image_.cols - 2 * kBorder),
                                    static_cast<float>(image_.rows - 2 * kBorder), wanted);
  if (starved) return describe(chosen, true, features);
  for (const Corner& corner : chosen) {
    features.push_back(feature_at(corner));
    features.back().movable = true;
    features.back().matchable = false;
  }
}

}  // namespace rds::tracker
