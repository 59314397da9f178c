// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/keyframe_objects.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <utility>

#include "services/mapper/core/object_region.hpp"
#include "services/mapper/core/segmentation.hpp"

namespace rds::mapper {
namespace {

constexpr double kBorderPx = 3;  // a box this near to the picture's border is cut by it
constexpr int kSameSurfaceTenthMm =
    500;  // depth step between a segment's pixel and its unsegmented neighbours
constexpr std::size_t kMinSightingPixels = 30;
constexpr double kMinShareInPlace = 0.5;  // of a segment's pixels in the object's box and depth interval

/// All sampled pixels of a segment that was found on every `stride`-th of them.
std::vector<std::size_t> refine(const Segment& segment, int stride, const KeyframeRecord& record) {
  std::vector<std::size_t> pixels;
  for (const auto i : segment.pixels) {
    const int x0 = static_cast<int>(i) % record.width;
    const int y0 = static_cast<int>(i) / record.width;
    for (int y = y0; y < std::min(record.height, y0 + stride); ++y)
      for (int x = x0; x < std::min(record.width, x0 + stride); ++x) {
        const auto j = static_cast<std::size_t>(y * record.width + x);
        if (std::abs(int{record.depth_tenth_mm[j]} - int{record.depth_tenth_mm[i]}) <= kSameSurfaceTenthMm)
          pixels.push_back(j);
      }
  }
  return pixels;
}

bool is_cut_by_border(const geometry::Box2& box, const geometry::CameraModel& camera) {
  return box.x0 < kBorderPx || box.y0 < kBorderPx || box.x1 > camera.width - kBorderPx ||
         box.y1 > camera.height - kBorderPx;
}

ObjectSighting sighting_of(const std::vector<std::size_t>& pixels, const LabelledBox& box,
                           std::uint16_t label, const geometry::Box2& box_px, const KeyframeRecord& record) {
  ObjectSighting sighting{label,
                          std::isfinite(box.score) ? std::clamp(box.score, 0.0F, 1.0F) : 0.0F,
                          is_cut_by_border(box_px, record.camera),
                          {}};
  const std::size_t step = pixels.size() / ObjectSighting::kMaxPoints + 1;
  for (std::size_t k = 0; k < pixels.size(); k += step)
    sighting.points_in_camera.push_back(record.point_in_camera(pixels[k]));
  return sighting;
}

/// The segments as far as they lie in the object's place; those that mostly lie elsewhere in depth are left
/// out.
std::vector<Segment> segments_in_place(const std::vector<Segment>& segments, const ObjectPlace& place,
                                       const KeyframeRecord& record) {
  std::vector<Segment> inside;
  for (const auto& segment : segments) {
    Segment part{segment.box_px, {}, segment.is_plane};
    std::ranges::copy_if(segment.pixels, std::back_inserter(part.pixels),
                         [&](std::size_t i) { return place.contains(record, i); });
    const bool mostly = static_cast<double>(part.pixels.size()) >=
                        kMinShareInPlace * static_cast<double>(segment.pixels.size());
    if (mostly && !part.pixels.empty()) inside.push_back(std::move(part));
  }
  return inside;
}

std::vector<std::size_t> static_pixels(const LabelledBox& box, const geometry::Box2& box_px,
                                       const std::vector<Segment>& segments, const KeyframeRecord& record,
                                       const MapperConfig& config) {
  const auto place = object_place(record, box, config.region);
  if (!place) return {};
  const auto candidates = segments_in_place(segments, *place, record);
  const Segment* found = best_segment(candidates, box_px, config.segmentation);
  auto pixels = found != nullptr ? refine(*found, config.segmentation.stride, record)
                                 : object_region(record, box, config.region);
  std::erase_if(pixels, [&](std::size_t i) { return record.use[i] != PixelUse::kStatic; });
  return pixels;
}

}  // namespace

void apply_boxes(KeyframeRecord& record, std::span<const LabelledBox> boxes, const MapperConfig& config,
                 LabelTable& labels) {
  classify_by_depth(record, config.sampling);
  record.labels.clear();
  record.sightings.clear();
  record.looked_for_objects = true;
  std::vector<const LabelledBox*> still;
  std::vector<std::vector<std::size_t>> moving;
  for (const auto& box : boxes)
    if (box.movable)
      moving.push_back(object_region(record, box, config.region));
    else
      still.push_back(&box);
  for (const auto& region : moving) mark_movable(record, region, config.region);
  set_aside_movable_cells(record);
  if (still.empty()) return;

  std::ranges::stable_sort(still, {}, [](const LabelledBox* b) { return std::pair(-b->score, b->depth_m); });
  const auto segments =
      config.segmentation.enabled ? segment(record, config.segmentation) : std::vector<Segment>{};
  record.labels.assign(record.size(), 0);
  for (const auto* box : still) {
    const auto box_px = image_box(*box, record);
    if (!box_px) continue;
    auto pixels = static_pixels(*box, *box_px, segments, record, config);
    std::erase_if(pixels,
                  [&](std::size_t i) { return record.labels[i] != 0; });  // of what is surer, or nearer
    const auto label = labels.index_of(box->label);
    if (pixels.size() < kMinSightingPixels || label == 0) continue;
    for (const auto i : pixels) record.labels[i] = label;
    record.sightings.push_back(sighting_of(pixels, *box, label, *box_px, record));
  }
}

}  // namespace rds::mapper
