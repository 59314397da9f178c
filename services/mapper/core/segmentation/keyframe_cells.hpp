// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "common/dynamic_segmentation/dynamic_segmentation.hpp"
#include "common/dynamic_segmentation/surfaces.hpp"
#include "services/mapper/core/keyframe/keyframe_record.hpp"

namespace rds::mapper {

/// Mean colours of the cells of a record's rays.
cv::Mat1w colours_in_cells(const KeyframeRecord& record);

/// A keyframe in the cells of its rays: the nearest depth of each cell, as the tracker takes it, among the
/// pixels that look static or are far, and its colours. The record must outlive it.
class KeyframeCells {
 public:
  /// @param colours  colours_in_cells().
  KeyframeCells(const KeyframeRecord& record, const cv::Mat1w& colours);

  /// What stands in the regions.
  [[nodiscard]] segmentation::Segmentation segment(std::span<const segmentation::ObjectRegion> regions,
                                                   const segmentation::EvidenceModel& model) const;
  [[nodiscard]] segmentation::Background background(
      const std::vector<segmentation::BackgroundPlane>& planes) const {
    return {cells_.depth_m, record_.grid.rays->cells(), planes};
  }
  /// Of a sampled pixel.
  [[nodiscard]] cv::Point cell_of(int column, int row) const {
    return {cell_of_[static_cast<std::size_t>(column)], cell_of_[static_cast<std::size_t>(row)]};
  }
  /// Whether a sampled pixel in that cell shows the surface that the cell stands for.
  [[nodiscard]] bool shows(std::size_t pixel, const cv::Point& cell) const {
    constexpr double kSurfaceStepM = 0.05;  // between the nearest of a cell and others of the same surface
    const float nearest_m = cells_.depth_m(cell);
    return nearest_m == 0 || segmentation::one_surface(record_.depth_m(pixel), nearest_m, kSurfaceStepM);
  }

 private:
  const KeyframeRecord& record_;
  std::vector<int> cell_of_;  // by a pixel's column or row
  segmentation::PictureCells cells_;
};

}  // namespace rds::mapper
