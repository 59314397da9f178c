// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/orb_extractor.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <opencv2/imgproc.hpp>

namespace rds::tracker {
namespace {

constexpr int kPatchRadius = 15;  // of the orientation's round patch
constexpr int kFastRadius = 3;
constexpr int kBorder = 19;  // the steered descriptor patch reaches this far
constexpr int kPatchSize = 31;
constexpr float kRadPerDegree = static_cast<float>(CV_PI / 180);

std::vector<int> features_per_level(const ExtractionConfig& config) {
  const double ratio = 1 / config.scale_factor;
  double wanted = config.features * (1 - ratio) / (1 - std::pow(ratio, config.levels));
  std::vector<int> quota;
  int given = 0;
  for (int l = 0; l + 1 < config.levels; ++l, wanted *= ratio) {
    quota.push_back(static_cast<int>(std::lround(wanted)));
    given += quota.back();
  }
  quota.push_back(std::max(0, config.features - given));
  return quota;
}

}  // namespace

OrbExtractor::OrbExtractor(const ExtractionConfig& config)
    : config_(config),
      quota_(features_per_level(config)),
      pyramid_(static_cast<std::size_t>(config.levels)),
      orb_(cv::ORB::create(config.features, 1.2F, 1, kBorder - 1, 0, 2, cv::ORB::HARRIS_SCORE, kPatchSize)) {
  for (int dy = -kPatchRadius; dy <= kPatchRadius; ++dy)
    patch_half_width_.push_back(
        static_cast<int>(std::sqrt(kPatchRadius * kPatchRadius - dy * dy + kPatchRadius)));
}

void OrbExtractor::build_pyramid(const cv::Mat& gray) {
  pyramid_[0] = gray;
  double scale = 1;
  for (std::size_t l = 1; l < pyramid_.size(); ++l) {
    scale *= config_.scale_factor;
    const cv::Size size(std::max(1, static_cast<int>(std::lround(gray.cols / scale))),
                        std::max(1, static_cast<int>(std::lround(gray.rows / scale))));
    cv::resize(pyramid_[l - 1], pyramid_[l], size, 0, 0, cv::INTER_LINEAR);
  }
}

void OrbExtractor::detect(int level, const cv::Rect& place, int threshold, const MovableTest& is_movable) {
  const cv::Rect seen(place.x - kFastRadius, place.y - kFastRadius, place.width + 2 * kFastRadius,
                      place.height + 2 * kFastRadius);
  cv::FAST(pyramid_[static_cast<std::size_t>(level)](seen), keypoints_, threshold, true);
  for (const cv::KeyPoint& k : keypoints_) {
    const Corner corner{k.pt.x + static_cast<float>(seen.x - kBorder),
                        k.pt.y + static_cast<float>(seen.y - kBorder), k.response};
    const bool movable = is_movable && is_movable(feature_at(level, corner).image_px);
    (movable ? movable_corners_ : corners_).push_back(corner);
  }
}

void OrbExtractor::find_corners(int level, const MovableTest& is_movable) {
  const cv::Mat& image = pyramid_[static_cast<std::size_t>(level)];
  corners_.clear();
  movable_corners_.clear();
  const cv::Rect inner(kBorder, kBorder, image.cols - 2 * kBorder, image.rows - 2 * kBorder);
  if (inner.width <= 0 || inner.height <= 0) return;
  detect(level, inner, config_.fast_threshold, is_movable);
  const int cell = config_.cell_px;
  const int columns = (inner.width + cell - 1) / cell;
  const int rows = (inner.height + cell - 1) / cell;
  corners_in_cell_.assign(static_cast<std::size_t>(columns * rows), 0);
  for (const Corner& c : corners_)
    ++corners_in_cell_[static_cast<std::size_t>(static_cast<int>(c.y) / cell * columns +
                                                static_cast<int>(c.x) / cell)];
  for (int i = 0; i < columns * rows; ++i)
    if (corners_in_cell_[static_cast<std::size_t>(i)] == 0)
      detect(level, cv::Rect(inner.x + i % columns * cell, inner.y + i / columns * cell, cell, cell) & inner,
             config_.fast_threshold_low, is_movable);
}

float OrbExtractor::orientation(const cv::Mat& image, int x, int y) const {
  int moment_x = 0;
  int moment_y = 0;
  for (int dy = -kPatchRadius; dy <= kPatchRadius; ++dy) {
    const int half = patch_half_width_[static_cast<std::size_t>(dy + kPatchRadius)];
    const std::uint8_t* row = image.ptr<std::uint8_t>(y + dy) + x;
    int row_sum = 0;
    for (int dx = -half; dx <= half; ++dx) {
      row_sum += row[dx];
      moment_x += dx * row[dx];
    }
    moment_y += dy * row_sum;
  }
  return cv::fastAtan2(static_cast<float>(moment_y), static_cast<float>(moment_x));
}

void OrbExtractor::describe(int level, const std::vector<Corner>& corners, bool movable,
                            std::vector<Feature>& features) {
  const cv::Mat& image = pyramid_[static_cast<std::size_t>(level)];
  keypoints_.clear();
  for (const Corner& c : corners) {
    const float x = c.x + kBorder;
    const float y = c.y + kBorder;
    const float angle = orientation(image, static_cast<int>(x), static_cast<int>(y));
    keypoints_.emplace_back(x, y, static_cast<float>(kPatchSize), angle, c.score, 0);
  }
  if (keypoints_.empty()) return;
  orb_->compute(image, keypoints_, descriptors_);
  for (std::size_t i = 0; i < keypoints_.size(); ++i) {
    Feature feature = feature_at(level, corners[i]);
    feature.movable = movable;
    feature.angle_rad = keypoints_[i].angle * kRadPerDegree;
    std::memcpy(feature.descriptor.data(), descriptors_.ptr(static_cast<int>(i)), feature.descriptor.size());
    features.push_back(feature);
  }
}

Feature OrbExtractor::feature_at(int level, const Corner& corner) const {
  // resize() keeps the centres of the corner pixels half a pixel inside, so levels differ by half pixels.
  const cv::Mat& image = pyramid_[static_cast<std::size_t>(level)];
  const float scale_x = static_cast<float>(pyramid_[0].cols) / static_cast<float>(image.cols);
  const float scale_y = static_cast<float>(pyramid_[0].rows) / static_cast<float>(image.rows);
  Feature feature;
  feature.image_px = {(corner.x + kBorder + 0.5F) * scale_x - 0.5F,
                      (corner.y + kBorder + 0.5F) * scale_y - 0.5F};
  feature.px = feature.image_px;
  feature.level = static_cast<std::uint8_t>(level);
  return feature;
}

void OrbExtractor::add_movable(int level, std::size_t quota, std::vector<Feature>& features) {
  const cv::Mat& image = pyramid_[static_cast<std::size_t>(level)];
  const std::size_t all = corners_.size() + movable_corners_.size();
  const bool starved =
      static_cast<double>(corners_.size()) < config_.starved_share * static_cast<double>(quota);
  // For show, as many as the budget would give to this share of the corners.
  const std::size_t wanted = starved ? quota - corners_.size() : quota * movable_corners_.size() / all;
  const auto chosen = spread_evenly(movable_corners_, static_cast<float>(image.cols - 2 * kBorder),
                                    static_cast<float>(image.rows - 2 * kBorder), wanted);
  if (starved) return describe(level, chosen, true, features);
  for (const Corner& corner : chosen) {
    features.push_back(feature_at(level, corner));
    features.back().movable = true;
    features.back().matchable = false;
  }
}

void OrbExtractor::extract(const cv::Mat& gray, const MovableTest& is_movable,
                           std::vector<Feature>& features) {
  features.clear();
  build_pyramid(gray);
  for (int l = 0; l < config_.levels; ++l) {
    const cv::Mat& image = pyramid_[static_cast<std::size_t>(l)];
    const auto quota = static_cast<std::size_t>(quota_[static_cast<std::size_t>(l)]);
    find_corners(l, is_movable);
    if (!movable_corners_.empty()) add_movable(l, quota, features);
    const auto chosen = spread_evenly(corners_, static_cast<float>(image.cols - 2 * kBorder),
                                      static_cast<float>(image.rows - 2 * kBorder), quota);
    describe(l, chosen, false, features);
  }
}

}  // namespace rds::tracker
