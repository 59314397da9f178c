// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/mapper/core/keyframe/keyframe_record.hpp"

namespace rds::mapper {

/// 255 where a pixel and all within 4 sampled pixels have no depth; 0 elsewhere, and near the picture's
/// border. Of the size of the sampled picture.
cv::Mat1b without_depth_all_around(const KeyframeRecord& record);

/// Tells flying pixels, which a camera measures between two surfaces, from surfaces.
class DepthSupport {
 public:
  /// @param record  must outlive this object.
  DepthSupport(const KeyframeRecord& record, const SamplingConfig& config);

  /// True if at least edge_support of the 8 neighbours have nearly this pixel's depth.
  [[nodiscard]] bool has(int column, int row) const;

 private:
  const KeyframeRecord& record_;
  float tolerance_at_1m_;  // [0.1 mm]
  int needed_;             // neighbours
};

}  // namespace rds::mapper
