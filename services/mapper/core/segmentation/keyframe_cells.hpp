// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "common/dynamic_segmentation/dynamic_segmentation.hpp"
#include "services/mapper/core/keyframe/keyframe_record.hpp"

namespace rds::mapper {

/// A keyframe in the cells of its rays: the nearest depth of each cell, as the tracker takes it, among the
/// pixels that look static or are far, and the mean of its colours. The record must outlive it.
class KeyframeCells {
 public:
  explicit KeyframeCells(const KeyframeRecord& record);

  /// What stands in the regions.
  [[nodiscard]] segmentation::Segmentation segment(std::span<const segmentation::ObjectRegion> regions,
                                                   const segmentation::EvidenceModel& model) const;
  [[nodiscard]] segmentation::Background background(
      const std::vector<segmentation::BackgroundPlane>& planes) const {
    return {cells_.depth_m, record_.grid.rays->cells(), planes};
  }
  /// Of a sampled pixel.
  [[nodiscard]] cv::Point cell_of(int column, int row) const {
    return {column * record_.grid.stride / cell_px_, row * record_.grid.stride / cell_px_};
  }
  /// Whether a sampled pixel in that cell shows the surface that the cell stands for.
  [[nodiscard]] bool shows(std::size_t pixel, const cv::Point& cell) const;

 private:
  const KeyframeRecord& record_;
  int cell_px_;
  segmentation::PictureCells cells_;
};

}  // namespace rds::mapper
