// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/segmentation/dynamic_masks.hpp"

#include <cmath>

#include <opencv2/imgproc.hpp>

#include "services/mapper/core/segmentation/background.hpp"
#include "services/mapper/core/segmentation/object_region.hpp"

namespace rds::mapper {
namespace {

/// Ten standard deviations across the axis: what is measured at a rim is a mixture of near and far over the
/// width of a matching window, and depth is laid on colour with an error of a pixel or two.
int rim_px(const geometry::DepthNoise& noise) {
  constexpr double kSigmas = 10;
  return static_cast<int>(std::ceil(kSigmas * noise.lateral_px));
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

}  // namespace

DynamicMasks segment_dynamic(const KeyframeRecord& record, std::span<const LabelledBox> boxes,
                             const MapperConfig& config) {
  const double margin = kMovableMarginPx;
  std::vector<geometry::Box2> boxes_px;
  std::vector<ObjectRegion> regions;
  for (const auto& box : boxes) {
    const auto px = box.movable ? image_box(box, record) : std::nullopt;
    if (!px) continue;
    boxes_px.push_back({px->x0 - margin, px->y0 - margin, px->x1 + margin, px->y1 + margin});
    regions.push_back(object_region(record, box));
  }
  if (boxes_px.empty()) return {};
  DynamicMasks masks;
  masks.background = find_background(record, boxes_px, config.sampling.depth_noise);
  masks.object.resize(record.size());
  for (const auto& region : regions)
    for (const auto i : region.pixels) masks.object[i] = 1;
  masks.beside = grown(masks.object, rim_px(config.sampling.depth_noise), record);
  for (const auto& region : regions)
    if (!region.pixels.empty())
      for (const auto i : region.small_parts) masks.beside[i] = 1;
  return masks;
}

}  // namespace rds::mapper
