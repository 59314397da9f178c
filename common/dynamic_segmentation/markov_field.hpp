// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core.hpp>

namespace rds::segmentation {

/// How much likelier neighbouring cells are alike than not, as the logarithm of the ratio, at least 0.
struct Couplings {
  cv::Mat1f right;  // of each cell with its right neighbour
  cv::Mat1f below;  // of each cell with the one below it
};

/// The most probable labels of a Markov random field of two labels on a grid: of each cell the logarithm of
/// how much likelier the best labelling is in which it is 1 than the best in which it is 0.
///
/// Max-product belief propagation (Pearl 1988; on grids Felzenszwalb & Huttenlocher 2006, §3). With two
/// labels and couplings K a message is one number, what the sender believes without what the receiver told
/// it, held within ±K. Messages are swept along rows and columns, to and fro, twice.
/// @param log_odds  what each cell says by itself.
cv::Mat1f propagate(const cv::Mat1f& log_odds, const Couplings& couplings);

}  // namespace rds::segmentation
