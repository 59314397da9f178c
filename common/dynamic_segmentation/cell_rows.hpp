// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace rds::segmentation {

/// A row of cells to compute with, a whole one at a time.
inline Eigen::Map<const Eigen::ArrayXf> row_of(const cv::Mat1f& cells, int row) {
  return {cells[row], cells.cols};
}
inline Eigen::Map<Eigen::ArrayXf> row_of(cv::Mat1f& cells, int row) {
  return {cells[row], cells.cols};
}

}  // namespace rds::segmentation
