// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/objects/object_view.hpp"

#include <limits>

#include "services/mapper/core/objects/trimmed_box.hpp"

namespace rds::mapper {
namespace {

geometry::Box3 box_in_map(const ObjectSighting& sighting, const geometry::Pose& map_from_camera) {
  const Eigen::Vector3d none = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  if (sighting.points_in_camera.empty()) return {none, none};
  std::vector<Eigen::Vector3d> in_map;
  in_map.reserve(sighting.points_in_camera.size());
  for (const auto& p : sighting.points_in_camera) in_map.emplace_back(map_from_camera * p.cast<double>());
  return trimmed_box(in_map);
}

}  // namespace

ObjectView ObjectView::of(const KeyframeRecord& record) {
  ObjectView view;
  view.keyframe_id = record.id;
  view.stamp_ns = record.stamp_ns;
  view.map_from_camera = record.map_from_camera;
  view.camera = record.grid.camera;
  view.looked_for = record.objects.looked_for;
  for (const ObjectSighting& sighting : record.objects.sightings)
    view.sightings.push_back({sighting.label, sighting.score, sighting.cut_by_border,
                              box_in_map(sighting, record.map_from_camera)});
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
