// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/objects/object_labels.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "services/mapper/core/segmentation/object_place.hpp"
#include "services/mapper/core/segmentation/static_objects.hpp"

namespace rds::mapper {
namespace {

constexpr double kBorderPx = 3;  // a box this near to the picture's border is cut by it
constexpr std::size_t kMinSightingPixels = 30;

bool is_cut_by_border(const geometry::Box2& box, const geometry::CameraModel& camera) {
  return box.x0 < kBorderPx || box.y0 < kBorderPx || box.x1 > camera.width - kBorderPx ||
         box.y1 > camera.height - kBorderPx;
}

ObjectSighting sighting_of(const std::vector<std::size_t>& pixels, const LabelledBox& box,
                           std::uint16_t label, const geometry::Box2& box_px, const KeyframeRecord& record) {
  ObjectSighting sighting{label,
                          std::isfinite(box.score) ? std::clamp(box.score, 0.0F, 1.0F) : 0.0F,
                          is_cut_by_border(box_px, record.grid.camera),
                          box_px,
                          {}};
  const std::size_t step = pixels.size() / ObjectSighting::kMaxPoints + 1;
  for (std::size_t k = 0; k < pixels.size(); k += step)
    sighting.points_in_camera.push_back(record.point_in_camera(pixels[k]));
  return sighting;
}

}  // namespace

void label_static_objects(KeyframeRecord& record, const cv::Mat1w& colours,
                          std::span<const LabelledBox> boxes, const MapperConfig& config,
                          LabelTable& labels) {
  record.objects.labels.clear();
  record.objects.sightings.clear();
  record.objects.looked_for = true;
  std::vector<const LabelledBox*> still;
  for (const auto& box : boxes)
    if (!box.movable) still.push_back(&box);
  if (still.empty()) return;
  std::ranges::stable_sort(still, {}, [](const LabelledBox* b) { return std::pair(-b->score, b->depth_m); });
  auto objects = segment_static(record, colours, still);
  record.objects.labels.assign(record.size(), 0);
  for (std::size_t k = 0; k < still.size(); ++k) {
    const LabelledBox* box = still[k];
    const auto box_px = image_box(*box, record);
    if (!box_px) continue;
    auto& [pixels, flush] = objects[k];
    if (flush && box->score < config.objects.flush_min_score) continue;
    std::erase_if(
        pixels, [&](std::size_t i) { return record.objects.labels[i] != 0; });  // of what is surer, or nearer
    const auto label = labels.index_of(box->label);
    if (pixels.size() < kMinSightingPixels || label == 0) continue;
    for (const auto i : pixels) record.objects.labels[i] = label;
    record.objects.sightings.push_back(sighting_of(pixels, *box, label, *box_px, record));
  }
}

}  // namespace rds::mapper
