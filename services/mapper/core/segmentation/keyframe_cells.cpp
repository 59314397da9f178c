// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/segmentation/keyframe_cells.hpp"

#include <opencv2/imgproc.hpp>

#include "common/dynamic_segmentation/colour_model.hpp"
#include "common/dynamic_segmentation/surfaces.hpp"

namespace rds::mapper {

KeyframeCells::KeyframeCells(const KeyframeRecord& record)
    : record_(record), cell_px_(record.grid.rays->cells().cell_px()) {
  const cv::Size size = record.grid.rays->cells().size();
  cells_ = {cv::Mat1f(size, 0.0F), cv::Mat1b(size, std::uint8_t{0}), {}};
  for (int row = 0; row < record.grid.height; ++row)
    for (int column = 0; column < record.grid.width; ++column) {
      const std::size_t pixel = record.grid.index(column, row);
      if (!looks_static(record.classes[pixel]) && record.classes[pixel] != PixelClass::kFar) continue;
      float& nearest_m = cells_.depth_m(cell_of(column, row));
      const float depth_m = record.depth_m(pixel);
      if (nearest_m == 0 || depth_m < nearest_m) nearest_m = depth_m;
    }
  // OpenCV has no picture of constant pixels; these are only read.
  auto* rgb = const_cast<std::uint8_t*>(record.rgb.data());
  image::ColorImage picture{{}, image::ChannelOrder::kRgb, {}};
  cv::resize(cv::Mat(record.grid.height, record.grid.width, CV_8UC3, rgb), picture.pixels, size, 0, 0,
             cv::INTER_AREA);
  cells_.colours = segmentation::colours_in_cells(picture, size, 1);
}

segmentation::Segmentation KeyframeCells::segment(std::span<const segmentation::ObjectRegion> regions,
                                                  const segmentation::EvidenceModel& model) const {
  return segmentation::segment(cells_, record_.grid.rays->cells(), {regions, {}, {}}, model);
}

bool KeyframeCells::shows(std::size_t pixel, const cv::Point& cell) const {
  constexpr double kSurfaceStepM = 0.05;  // between the nearest of a cell and others of the same surface
  const float nearest_m = cells_.depth_m(cell);
  return nearest_m == 0 || segmentation::one_surface(record_.depth_m(pixel), nearest_m, kSurfaceStepM);
}

}  // namespace rds::mapper
