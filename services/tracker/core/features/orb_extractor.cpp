// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/features/orb_extractor.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace rds::tracker {
namespace {

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

OrbExtractor::OrbExtractor(const ExtractionConfig& config, Executor executor)
    : config_(config),
      executor_(std::move(executor)),
      pyramid_(static_cast<std::size_t>(config.levels)),
      features_(static_cast<std::size_t>(config.levels)) {
  for (const int quota : features_per_level(config))
    levels_.emplace_back(config, static_cast<int>(levels_.size()), static_cast<std::size_t>(quota));
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

void OrbExtractor::extract(const cv::Mat& gray, const MovableTest& is_movable,
                           std::vector<Feature>& features) {
  build_pyramid(gray);
  executor_(levels_.size(),
            [&](std::size_t l) { levels_[l].extract(pyramid_[l], gray.size(), is_movable, features_[l]); });
  features.clear();
  for (const auto& of_level : features_) features.insert(features.end(), of_level.begin(), of_level.end());
}

std::unique_ptr<FeatureExtractor> make_feature_extractor(const ExtractionConfig& config, Executor executor) {
  return std::make_unique<OrbExtractor>(config, std::move(executor));
}

}  // namespace rds::tracker
