// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "common/image/tum_dataset.hpp"
#include "tools/rds/finding.hpp"

namespace rds::tools {

/// What one frame's pictures look like.
struct FrameLook {
  std::int64_t stamp_ns = 0;
  double brightness = 0;      // mean grey value, 0 … 255
  double sharpness = 0;       // variance of the Laplacian of the grey picture
  double change = 0;          // mean absolute grey difference to the frame before; NaN for the first
  double depth_share = 0;     // pixels with a measurement, 0 … 1
  double median_depth_m = 0;  // of those; 0 without any
};

struct DatasetLooks {
  std::vector<FrameLook> frames;
  std::vector<std::string> unreadable;  // one sentence each
};

/// Decodes every `every`-th frame and measures it.
DatasetLooks look_at_pictures(const image::TumDataset& dataset, std::size_t every);

/// Counts, pairing, gaps and truth: what the lists alone tell.
std::vector<Finding> check_lists(const image::TumDataset& dataset);

/// Unreadable, frozen, blurred, dark and over-exposed pictures; depth that cannot be in metres as it is
/// scaled.
std::vector<Finding> check_looks(const DatasetLooks& looks, double depth_scale);

}  // namespace rds::tools
