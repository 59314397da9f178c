// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/map_outputs.hpp"

#include <algorithm>
#include <chrono>
#include <memory>

#include "common/messages/conversions.hpp"
#include "common/service/random_id.hpp"
#include "common/topics/endpoints.hpp"
#include "services/mapper/core/octree/tree_bytes.hpp"

namespace rds::mapper {
namespace {

std::array<double, 3> to_array(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

}  // namespace

MapOutputs::MapOutputs(service::ServiceContext& context, const GridConfig& grid)
    : grid_config_(grid),
      instance_(context.instance),
      map_id_(service::random_id()),
      delta_(topics::advertise(context.bus, topics::kMapDelta, topics::kMapper)),
      full_(topics::advertise(context.bus, topics::kMapFull, topics::kMapper)),
      binary_(topics::advertise(context.bus, topics::kMapBinary, topics::kMapper)),
      points_(topics::advertise(context.bus, topics::kMapPoints, topics::kMapper)),
      info_(topics::advertise(context.bus, topics::kMapInfo, topics::kMapper)),
      objects_(topics::advertise(context.bus, topics::kMapObjects, topics::kMapper)),
      markers_(topics::advertise(context.bus, topics::kMapMarkers, topics::kMapper)),
      grid_(topics::advertise(context.bus, topics::kMapGrid, topics::kMapper)),
      full_map_latency_(context.diagnostics.latency("full map")) {}

void MapOutputs::begin_map() {
  map_id_ = service::random_id();
}

bool MapOutputs::has_new_reader() {
  const int readers = full_.matched() + delta_.matched() + binary_.matched() + points_.matched();
  const bool more = readers > readers_;
  readers_ = readers;
  return more;
}

void MapOutputs::publish_delta(MapDelta delta) {
  if (delta.is_noop()) return;
  delta.map_id = map_id_;
  sender_.send([this, delta = std::make_shared<MapDelta>(std::move(delta))] {
    auto message = to_message(*delta);
    message.instance(instance_);
    delta_.write(message);
  });
}

rds_msgs::msg::MapInfo MapOutputs::info_of(const SemanticMapper& mapper, const MapProgress& progress,
                                           std::int64_t stamp_ns) const {
  rds_msgs::msg::MapInfo info;
  info.header(messages::make_header(stamp_ns, "map"));
  info.instance(instance_);
  info.map_epoch(mapper.map_epoch());
  info.map_id(map_id_);
  info.revision(mapper.revision());
  const MapExtent extent = extent_of(mapper.tree());
  info.resolution(mapper.tree().getResolution());
  info.node_count(mapper.tree().size());
  info.occupied_count(extent.occupied);
  info.bounds_min(to_array(extent.min));
  info.bounds_max(to_array(extent.max));
  info.labels(mapper.labels().names());
  info.keyframes_integrated(mapper.archive().size());
  info.last_keyframe_id(progress.last_keyframe_id);
  info.keyframes_waiting(progress.keyframes_waiting);
  return info;
}

void MapOutputs::publish_info(const SemanticMapper& mapper, const MapProgress& progress,
                              std::int64_t stamp_ns) {
  sender_.send([this, info = info_of(mapper, progress, stamp_ns)] { info_.write(info); });
}

void MapOutputs::publish_all(const SemanticMapper& mapper, const MapProgress& progress,
                             std::int64_t stamp_ns) {
  stamp_ns_ = std::max(stamp_ns, stamp_ns_ + 1);
  ++full_maps_under_way_;
  sender_.send([this, stamp = stamp_ns_, info = info_of(mapper, progress, stamp_ns_),
                snapshot = std::make_shared<MapSnapshot>(take_snapshot(mapper))]() mutable {
    const std::shared_ptr<void> done(nullptr, [this](void*) { --full_maps_under_way_; });
    write_all(*snapshot, info, stamp);
  });
}

void MapOutputs::write_all(const MapSnapshot& snapshot, rds_msgs::msg::MapInfo& info, std::int64_t stamp_ns) {
  const auto started = std::chrono::steady_clock::now();
  const auto tree = tree_from_bytes(snapshot.nodes, snapshot.resolution).value();
  LabelRows untold = labels_not_told_by_colors(*tree, snapshot);
  info.describes_full(true);
  info.label_keys(std::move(untold.keys));
  info.label_values(std::move(untold.values));
  full_.write(full_message(snapshot, stamp_ns));
  info_.write(info);
  objects_.write(objects_message(snapshot.objects, stamp_ns));
  markers_.write(markers_message(snapshot.objects, stamp_ns));
  grid_.write(grid_message(make_grid(*tree, snapshot.up, grid_config_), stamp_ns));
  if (binary_.matched() > 0) binary_.write(binary_message(*tree, stamp_ns));
  if (points_.matched() > 0) points_.write(points_message(points_of(*tree, snapshot), stamp_ns));
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - started;
  full_map_latency_.add_ms(took.count());
}

}  // namespace rds::mapper
