// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/dynamic_segmentation/evidence_model.hpp"
#include "common/dynamic_segmentation/markov_field.hpp"
#include "common/geometry/depth_noise.hpp"

namespace rds::segmentation {

/// Neighbouring cells are of one thing unless depth steps between them (README.md).
/// @param depth_m  of each cell; 0 where it was not measured.
Couplings couple(const cv::Mat1f& depth_m, const geometry::DepthNoise& noise, const EvidenceModel& model);

}  // namespace rds::segmentation
