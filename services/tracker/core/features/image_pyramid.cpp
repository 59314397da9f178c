// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/features/image_pyramid.hpp"

#include <opencv2/imgproc.hpp>

namespace rds::tracker {

ImagePyramid::ImagePyramid(const cv::Mat& gray, int levels) : levels_{gray} {
  while (this->levels() < levels) {
    const cv::Mat& finer = levels_.back();
    const cv::Size size(finer.cols / 2, finer.rows / 2);
    if (size.empty()) break;
    cv::Mat coarser;
    cv::resize(finer(cv::Rect(0, 0, 2 * size.width, 2 * size.height)), coarser, size, 0, 0, cv::INTER_AREA);
    levels_.push_back(coarser);
  }
}

ImagePyramid ImagePyramid::copied_to(std::uint8_t* memory) const {
  std::vector<cv::Mat> copies;
  for (const cv::Mat& level : levels_) {
    copies.emplace_back(level.size(), level.type(), memory);
    level.copyTo(copies.back());
    memory += copies.back().total();
  }
  return ImagePyramid(std::move(copies));
}

std::size_t ImagePyramid::bytes() const {
  std::size_t bytes = 0;
  for (const cv::Mat& level : levels_) bytes += level.total();
  return bytes;
}

}  // namespace rds::tracker
