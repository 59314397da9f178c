// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/segmentation/dynamic_masks.hpp"

#include <algorithm>

#include <opencv2/imgproc.hpp>

#include "services/mapper/core/segmentation/keyframe_cells.hpp"
#include "services/mapper/core/segmentation/object_place.hpp"

namespace rds::mapper {
namespace {

using segmentation::ObjectRegion;

/// Boxes are of this very picture. Outside them movable is what a detector misses: one in twenty of what
/// fills a fifth of the picture.
constexpr segmentation::EvidenceModel kModel{.unseen = 0.01F};

/// Five standard deviations across the axis: depth is laid on colour with an error of a pixel or two. What is
/// mixed of near and far over the width of a matching window is within a cell.
int rim_px(const geometry::DepthNoise& noise) {
  constexpr double kSigmas = 5;
  return static_cast<int>(kSigmas * noise.lateral_px);
}

/// Standard deviation along the narrower side of a plane that is nobody's back: 0.55 m.
constexpr float kWiderThanAPersonM = 0.16F;

/// What is beside movable pixels tells nothing else.
void add_rim(int by_px, const KeyframeRecord& record, std::vector<ByBoxes>& told) {
  cv::Mat1b rim(record.grid.height, record.grid.width);
  std::ranges::transform(told, rim.begin(), [](ByBoxes its) {
    return its == ByBoxes::kMovable ? std::uint8_t{255} : std::uint8_t{0};
  });
  const int side = 2 * ((by_px + record.grid.stride - 1) / record.grid.stride) + 1;
  cv::dilate(rim, rim, cv::getStructuringElement(cv::MORPH_RECT, {side, side}));
  std::ranges::transform(told, rim, told.begin(), [](ByBoxes its, std::uint8_t is_in_rim) {
    return is_in_rim != 0 ? std::max(its, ByBoxes::kBeside) : its;
  });
}

std::vector<ObjectRegion> movable_regions(const KeyframeRecord& record, std::span<const LabelledBox> boxes) {
  constexpr float kAnyDepthM = 100;
  std::vector<ObjectRegion> regions;
  for (const LabelledBox& box : boxes) {
    const auto px = box.movable ? image_box(box, record) : std::nullopt;
    if (px) regions.push_back(object_place(record, box).value_or(ObjectRegion{*px, 0, kAnyDepthM}));
  }
  return regions;
}

/// What the surface that each cell stands for is of.
cv::Mat1b shown_in(const KeyframeCells& cells, segmentation::Segmentation found) {
  std::erase_if(found.planes, [](const auto& plane) { return plane.narrow_m < kWiderThanAPersonM; });
  const segmentation::Background background = cells.background(found.planes);
  cv::Mat1b shown(found.log_odds.size());
  for (cv::Point cell; cell.y < shown.rows; ++cell.y)
    for (cell.x = 0; cell.x < shown.cols; ++cell.x) {
      const bool is_movable = found.log_odds(cell) > 0;
      const ByBoxes fixed =
          !is_movable && background.shows_at(cell) ? ByBoxes::kBackground : ByBoxes::kNothing;
      shown(cell) = static_cast<std::uint8_t>(is_movable ? ByBoxes::kMovable : fixed);
    }
  return shown;
}

}  // namespace

std::vector<ByBoxes> segment_dynamic(const KeyframeRecord& record, const cv::Mat1w& colours,
                                     std::span<const LabelledBox> boxes) {
  const std::vector<ObjectRegion> regions = movable_regions(record, boxes);
  if (regions.empty()) return {};
  const KeyframeCells cells(record, colours);
  const cv::Mat1b shown = shown_in(cells, cells.segment(regions, kModel));
  std::vector<ByBoxes> told(record.size());
  for (int row = 0; row < record.grid.height; ++row)
    for (int column = 0; column < record.grid.width; ++column) {
      const cv::Point cell = cells.cell_of(column, row);
      const auto of_cell = static_cast<ByBoxes>(shown(cell));
      if (of_cell == ByBoxes::kNothing) continue;
      const std::size_t pixel = record.grid.index(column, row);
      const ByBoxes of_others = of_cell == ByBoxes::kMovable ? ByBoxes::kBeside : ByBoxes::kNothing;
      told[pixel] = cells.shows(pixel, cell) ? of_cell : of_others;
    }
  add_rim(rim_px(record.grid.rays->cells().noise()), record, told);
  return told;
}

}  // namespace rds::mapper
