// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/segmentation/static_objects.hpp"

#include <utility>

#include "services/mapper/core/segmentation/keyframe_cells.hpp"
#include "services/mapper/core/segmentation/object_place.hpp"

namespace rds::mapper {
namespace {

using segmentation::ObjectRegion;

/// Things bound on each other as people seldom do: a chair stands on its floor. So planes outweigh what is
/// known of depth; and a screen has the colour of the next one, which has no box.
constexpr segmentation::EvidenceModel kModel{
    .unseen = 0.01F, .filled = 0.95F, .plane = -6, .colour_weight = 1};
/// Share of what shows in the box at the object's depth: with less standing out it is flush.
constexpr double kStandsOut = 0.3;

StaticObject object_in(const ObjectRegion& region, const KeyframeRecord& record, const KeyframeCells& cells,
                       const cv::Mat1f& log_odds) {
  StaticObject object;
  std::vector<std::size_t> at_its_depth;
  const cv::Rect box = record.grid.inside(region.box_px);
  for (int row = box.y; row < box.br().y; ++row)
    for (int column = box.x; column < box.br().x; ++column) {
      const std::size_t pixel = record.grid.index(column, row);
      const float depth_m = record.depth_m(pixel);
      if (!looks_static(record.classes[pixel]) || depth_m > region.max_depth_m) continue;
      if (depth_m >= region.min_depth_m) at_its_depth.push_back(pixel);
      const cv::Point cell = cells.cell_of(column, row);
      if (log_odds(cell) > 0 && cells.shows(pixel, cell)) object.pixels.push_back(pixel);
    }
  object.flush =
      static_cast<double>(object.pixels.size()) < kStandsOut * static_cast<double>(at_its_depth.size());
  if (object.flush) object.pixels = std::move(at_its_depth);
  return object;
}

}  // namespace

std::vector<StaticObject> segment_static(const KeyframeRecord& record, const cv::Mat1w& colours,
                                         std::span<const LabelledBox* const> boxes) {
  std::vector<StaticObject> objects(boxes.size());
  std::vector<std::size_t> places;  // of each region, among the boxes
  std::vector<ObjectRegion> regions;
  for (std::size_t i = 0; i < boxes.size(); ++i)
    if (const auto region = object_place(record, *boxes[i])) {
      regions.push_back(*region);
      places.push_back(i);
    }
  if (regions.empty()) return objects;
  const KeyframeCells cells(record, colours);
  const cv::Mat1f log_odds = cells.segment(regions, kModel).log_odds;
  for (std::size_t k = 0; k < regions.size(); ++k)
    objects[places[k]] = object_in(regions[k], record, cells, log_odds);
  return objects;
}

}  // namespace rds::mapper
