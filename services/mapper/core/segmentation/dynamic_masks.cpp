// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/segmentation/dynamic_masks.hpp"

#include <cmath>

#include <opencv2/imgproc.hpp>

#include "common/dynamic_segmentation/colour_model.hpp"
#include "common/dynamic_segmentation/dynamic_segmentation.hpp"
#include "common/dynamic_segmentation/surfaces.hpp"
#include "services/mapper/core/segmentation/background.hpp"
#include "services/mapper/core/segmentation/object_region.hpp"

namespace rds::mapper {
namespace {

using segmentation::MovableRegion;
using segmentation::PictureCells;

/// Boxes are of this very picture. Outside them movable is what a detector misses: one in twenty of what
/// fills a fifth of the picture.
constexpr segmentation::EvidenceModel kModel{.unseen = 0.01F};

/// Five standard deviations across the axis: depth is laid on colour with an error of a pixel or two. What is
/// mixed of near and far over the width of a matching window is within a cell.
int rim_px(const geometry::DepthNoise& noise) {
  constexpr double kSigmas = 5;
  return static_cast<int>(kSigmas * noise.lateral_px);
}

/// A mask grown to all sides.
std::vector<std::uint8_t> grown(std::vector<std::uint8_t>& mask, int by_px, const KeyframeRecord& record) {
  std::vector<std::uint8_t> rim(mask.size());
  const int radius = (by_px + record.grid.stride - 1) / record.grid.stride;
  cv::Mat1b to(record.grid.height, record.grid.width, rim.data());
  cv::dilate(cv::Mat1b(record.grid.height, record.grid.width, mask.data()), to,
             cv::getStructuringElement(cv::MORPH_RECT, {2 * radius + 1, 2 * radius + 1}));
  return rim;
}

std::vector<MovableRegion> movable_regions(const KeyframeRecord& record, std::span<const LabelledBox> boxes) {
  constexpr float kAnyDepthM = 100;
  std::vector<MovableRegion> regions;
  for (const LabelledBox& box : boxes) {
    const auto px = box.movable ? image_box(box, record) : std::nullopt;
    if (!px) continue;
    const auto place = object_place(record, box);
    regions.push_back({*px, place ? place->min_depth_m : 0, place ? place->max_depth_m : kAnyDepthM});
  }
  return regions;
}

/// 1 on planes that go on outside the regions.
std::vector<std::uint8_t> background_of(const KeyframeRecord& record, std::span<const MovableRegion> regions,
                                        const geometry::DepthNoise& noise) {
  constexpr double kMarginPx = 24;  // detectors cut off hands and feet
  std::vector<geometry::Box2> boxes;
  for (const MovableRegion& region : regions) {
    const geometry::Box2& box = region.box_px;
    boxes.push_back({box.x0 - kMarginPx, box.y0 - kMarginPx, box.x1 + kMarginPx, box.y1 + kMarginPx});
  }
  return find_background(record, boxes, noise);
}

/// Calls visit(pixel, cell) for all sampled pixels.
template <class Visit>
void for_each_pixel(const PixelGrid& grid, Visit visit) {
  const int cell_px = grid.rays->cells().cell_px();
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column)
      visit(grid.index(column, row), cv::Point(column * grid.stride / cell_px, row * grid.stride / cell_px));
}

/// The nearest of each cell's depths, as the tracker takes it, and the mean of its colours.
PictureCells cells_of(const KeyframeRecord& record) {
  const cv::Size size = record.grid.rays->cells().size();
  PictureCells cells{cv::Mat1f(size, 0.0F), cv::Mat1b(size, std::uint8_t{0}), {}};
  for_each_pixel(record.grid, [&](std::size_t pixel, const cv::Point& cell) {
    const PixelClass its_class = record.classes[pixel];
    if (its_class != PixelClass::kStatic && its_class != PixelClass::kFar) return;
    float& nearest_m = cells.depth_m(cell);
    const float depth_m = record.depth_m(pixel);
    if (nearest_m == 0 || depth_m < nearest_m) nearest_m = depth_m;
  });
  // OpenCV has no picture of constant pixels; these are only read.
  auto* rgb = const_cast<std::uint8_t*>(record.rgb.data());
  image::ColorImage picture{{}, image::ChannelOrder::kRgb, {}};
  cv::resize(cv::Mat(record.grid.height, record.grid.width, CV_8UC3, rgb), picture.pixels, size, 0, 0,
             cv::INTER_AREA);
  cells.colours = segmentation::colours_in_cells(picture, size, 1);
  return cells;
}

}  // namespace

DynamicMasks segment_dynamic(const KeyframeRecord& record, std::span<const LabelledBox> boxes,
                             const MapperConfig& config) {
  constexpr double kSurfaceStepM = 0.05;  // between the nearest of a cell and others of the same surface
  const std::vector<MovableRegion> regions = movable_regions(record, boxes);
  if (regions.empty()) return {};
  const PictureCells cells = cells_of(record);
  const cv::Mat1f log_odds =
      segmentation::segment(cells, record.grid.rays->cells(), {regions, {}, {}}, kModel).log_odds;
  const geometry::DepthNoise& noise = config.sampling.depth_noise;
  DynamicMasks masks{std::vector<std::uint8_t>(record.size()), {}, background_of(record, regions, noise)};
  std::vector<std::uint8_t> other(record.size());
  for_each_pixel(record.grid, [&](std::size_t pixel, const cv::Point& cell) {
    if (!(log_odds(cell) > 0)) return;
    const float cells_m = cells.depth_m(cell);
    const bool shows =
        cells_m == 0 || segmentation::one_surface(record.depth_m(pixel), cells_m, kSurfaceStepM);
    (shows ? masks.object : other)[pixel] = 1;
  });
  masks.beside = grown(masks.object, rim_px(noise), record);
  for (std::size_t i = 0; i < other.size(); ++i) masks.beside[i] |= other[i];
  return masks;
}

}  // namespace rds::mapper
