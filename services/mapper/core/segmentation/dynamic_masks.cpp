// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/segmentation/dynamic_masks.hpp"

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

/// A mask grown to all sides.
std::vector<std::uint8_t> grown(std::vector<std::uint8_t>& mask, int by_px, const KeyframeRecord& record) {
  std::vector<std::uint8_t> rim(mask.size());
  const int radius = (by_px + record.grid.stride - 1) / record.grid.stride;
  cv::Mat1b to(record.grid.height, record.grid.width, rim.data());
  cv::dilate(cv::Mat1b(record.grid.height, record.grid.width, mask.data()), to,
             cv::getStructuringElement(cv::MORPH_RECT, {2 * radius + 1, 2 * radius + 1}));
  return rim;
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

}  // namespace

DynamicMasks segment_dynamic(const KeyframeRecord& record, std::span<const LabelledBox> boxes,
                             const geometry::DepthNoise& noise) {
  const std::vector<ObjectRegion> regions = movable_regions(record, boxes);
  if (regions.empty()) return {};
  const KeyframeCells cells(record);
  segmentation::Segmentation found = cells.segment(regions, kModel);
  std::erase_if(found.planes, [](const auto& plane) { return plane.narrow_m < kWiderThanAPersonM; });
  const segmentation::Background background = cells.background(found.planes);
  const std::vector<std::uint8_t> none(record.size());
  DynamicMasks masks{none, none, none};
  std::vector<std::uint8_t> other = none;
  for (int row = 0; row < record.grid.height; ++row)
    for (int column = 0; column < record.grid.width; ++column) {
      const cv::Point cell = cells.cell_of(column, row);
      const std::size_t pixel = record.grid.index(column, row);
      if (found.log_odds(cell) > 0)
        (cells.shows(pixel, cell) ? masks.object : other)[pixel] = 1;
      else if (cells.shows(pixel, cell) && background.shows_at(cell))
        masks.background[pixel] = 1;
    }
  masks.beside = grown(masks.object, rim_px(noise), record);
  for (std::size_t i = 0; i < other.size(); ++i) masks.beside[i] |= other[i];
  return masks;
}

}  // namespace rds::mapper
