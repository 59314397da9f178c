// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/segmentation/keyframe_cells.hpp"

#include <algorithm>

#include <opencv2/imgproc.hpp>

#include "common/dynamic_segmentation/colour_model.hpp"

namespace rds::mapper {

cv::Mat1w colours_in_cells(const KeyframeRecord& record) {
  const cv::Size size = record.grid.rays->cells().size();
  // OpenCV has no picture of constant pixels; these are only read.
  auto* rgb = const_cast<std::uint8_t*>(record.rgb.data());
  image::ColorImage picture{{}, image::ChannelOrder::kRgb, {}};
  cv::resize(cv::Mat(record.grid.height, record.grid.width, CV_8UC3, rgb), picture.pixels, size, 0, 0,
             cv::INTER_AREA);
  return segmentation::colours_in_cells(picture, size, 1);
}

KeyframeCells::KeyframeCells(const KeyframeRecord& record, const cv::Mat1w& colours) : record_(record) {
  const segmentation::GridGeometry& grid = record.grid.rays->cells();
  for (int i = 0; i < std::max(record.grid.width, record.grid.height); ++i)
    cell_of_.push_back(i * record.grid.stride / grid.cell_px());
  cells_ = {cv::Mat1f(grid.size(), 0.0F), cv::Mat1b(grid.size(), std::uint8_t{0}), colours};
  for (int row = 0; row < record.grid.height; ++row)
    for (int column = 0; column < record.grid.width; ++column) {
      const std::size_t pixel = record.grid.index(column, row);
      if (!looks_static(record.classes[pixel]) && record.classes[pixel] != PixelClass::kFar) continue;
      float& nearest_m = cells_.depth_m(cell_of(column, row));
      const float depth_m = record.depth_m(pixel);
      if (nearest_m == 0 || depth_m < nearest_m) nearest_m = depth_m;
    }
}

segmentation::Segmentation KeyframeCells::segment(std::span<const segmentation::ObjectRegion> regions,
                                                  const segmentation::EvidenceModel& model) const {
  return segmentation::segment(cells_, record_.grid.rays->cells(), {regions, {}, {}}, model);
}

}  // namespace rds::mapper
