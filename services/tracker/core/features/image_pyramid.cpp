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

}  // namespace rds::tracker
