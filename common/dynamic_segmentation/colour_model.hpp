// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <opencv2/core.hpp>

#include "common/dynamic_segmentation/evidence_model.hpp"
#include "common/image/rgbd_frame.hpp"

namespace rds::segmentation {

/// Of each cell its colour, as the number of one of some hundred that are told apart.
using ColourCells = cv::Mat1w;

/// Mean of four pixels of every cell, as far as it has more than one.
/// @param size  of the cells, cell_px wide and high.
ColourCells colours_in_cells(const image::ColorImage& picture, const cv::Size& size, int cell_px);

/// Of each cell log(P(its colour | movable) / P(its colour | static)), by the colours that movable and static
/// cells of this picture have: two histograms, as in GrabCut (Rother, Kolmogorov & Blake 2004; Boykov & Jolly
/// 2001, §3).
/// @param log_odds  above 0: is taken for movable.
cv::Mat1f colour_ratio(const ColourCells& colours, const cv::Mat1f& log_odds, const EvidenceModel& model);

}  // namespace rds::segmentation
