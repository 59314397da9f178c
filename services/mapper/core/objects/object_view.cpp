// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/objects/object_view.hpp"

namespace rds::mapper {

ObjectView ObjectView::of(const KeyframeRecord& record) {
  ObjectView view;
  view.keyframe_id = record.id;
  view.stamp_ns = record.stamp_ns;
  view.map_from_camera = record.map_from_camera;
  view.camera = record.grid.camera;
  view.looked_for = record.objects.looked_for;
  view.sightings = record.objects.sightings;
  view.step_px = kProbeStep * record.grid.stride;
  for (int row = kProbeStep / 2; row < record.grid.height; row += kProbeStep, ++view.rows)
    for (int column = kProbeStep / 2; column < record.grid.width; column += kProbeStep) {
      const auto i = record.grid.index(column, row);
      view.depth_tenth_mm.push_back(record.depth_tenth_mm[i]);
      view.is_dynamic.push_back(record.classes[i] == PixelClass::kDynamic);
    }
  view.columns = view.rows == 0 ? 0 : static_cast<int>(view.depth_tenth_mm.size()) / view.rows;
  return view;
}

}  // namespace rds::mapper
