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

using Clock = std::chrono::steady_clock;
constexpr std::chrono::seconds kViewPeriod{1};

std::array<double, 3> to_array(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

auto tree_of(const MapSnapshot& snapshot) {
  return tree_from_bytes(snapshot.nodes, snapshot.resolution).value();
}

void prefix(std_msgs::msg::Header& header, const std::string& frame_prefix) {
  header.frame_id(frame_prefix + header.frame_id());
}

/// The message in the frame of this robot, where it has a frame prefix.
template <class Message>
Message of_robot(Message message, const std::string& frame_prefix) {
  if (frame_prefix.empty()) return message;
  if constexpr (requires { message.markers(); })
    for (auto& marker : message.markers()) prefix(marker.header(), frame_prefix);
  if constexpr (requires { message.detections(); })
    for (auto& detection : message.detections()) prefix(detection.header(), frame_prefix);
  if constexpr (requires { message.header(); }) prefix(message.header(), frame_prefix);
  return message;
}

}  // namespace

MapOutputs::MapOutputs(service::ServiceContext& context, const GridConfig& grid, int full_map_every)
    : grid_config_(grid),
      full_map_every_(full_map_every),
      instance_(context.instance),
      frame_prefix_(context.frame_prefix),
      map_id_(service::random_id()),
      topics_{topics::advertise(context.bus, topics::kMapDelta, topics::kMapper),
              topics::advertise(context.bus, topics::kMapFull, topics::kMapper),
              topics::advertise(context.bus, topics::kMapBinary, topics::kMapper),
              topics::advertise(context.bus, topics::kMapPoints, topics::kMapper),
              topics::advertise(context.bus, topics::kMapInfo, topics::kMapper),
              topics::advertise(context.bus, topics::kMapObjects, topics::kMapper),
              topics::advertise(context.bus, topics::kMapMarkers, topics::kMapper)},
      grid_(context.bus),
      full_map_latency_(context.diagnostics.latency("full map")),
      sharing_(context) {}

void MapOutputs::reconfigure(const GridConfig& grid, int full_map_every) {
  sender_.send([this, grid] { grid_config_ = grid; });
  full_map_every_ = full_map_every;
  views_ = {};
}

void MapOutputs::begin_map() {
  map_id_ = service::random_id();
  sharing_.begin_map();
  keyframe_.id = 0;  // the stamp stays: those of full maps never go back
}

void MapOutputs::note_keyframe(std::uint64_t id, std::int64_t stamp_ns) {
  keyframe_ = {id, stamp_ns};
  ++since_full_;
}

bool MapOutputs::has_new_reader() {
  const int readers =
      topics_.full.matched() + topics_.delta.matched() + topics_.binary.matched() + topics_.points.matched();
  const bool more = readers > readers_;
  readers_ = readers;
  return more;
}

void MapOutputs::publish_delta(MapDelta step, const SemanticMapper& mapper) {
  if (step.is_noop()) return;
  step.map_id = map_id_;
  const auto delta = std::make_shared<const MapDelta>(std::move(step));
  sharing_.add(delta, mapper.map().labels.names());
  sender_.send([this, delta] {
    auto message = to_message(*delta);
    message.instance(instance_);
    topics_.delta.write(message);
  });
}

rds_msgs::msg::MapInfo MapOutputs::info_of(const SemanticMapper& mapper, std::size_t keyframes_waiting,
                                           std::int64_t stamp_ns) const {
  rds_msgs::msg::MapInfo info;
  info.header(messages::make_header(stamp_ns, "map"));
  info.instance(instance_);
  info.map_epoch(mapper.map().epoch);
  info.map_id(map_id_);
  info.revision(mapper.map().revision);
  const MapExtent extent = extent_of(mapper.map().content->octree);
  info.resolution(mapper.map().tree().getResolution());
  info.node_count(mapper.map().tree().size());
  info.occupied_count(extent.occupied);
  info.bounds_min(to_array(extent.min));
  info.bounds_max(to_array(extent.max));
  info.labels(mapper.map().labels.names());
  info.keyframes_integrated(mapper.archive().size());
  info.last_keyframe_id(keyframe_.id);
  info.keyframes_waiting(keyframes_waiting);
  return info;
}

void MapOutputs::share_map(const SemanticMapper& mapper) {
  if (!sharing_.wants_map() || mapper.map().revision == 0) return;
  const auto snapshot = std::make_shared<const MapSnapshot>(take_snapshot(mapper));
  MapDelta head;
  head.map_epoch = mapper.map().epoch;
  head.map_id = map_id_;
  head.revision = mapper.map().revision;
  head.keyframe_id = keyframe_.id;
  head.stamp_ns = keyframe_.stamp_ns;
  sharing_.start([snapshot, head] { return whole_map(*tree_of(*snapshot), *snapshot, head); },
                 snapshot->labels);
}

void MapOutputs::publish(MapDelta delta, const SemanticMapper& mapper, std::size_t keyframes_waiting) {
  publish_delta(std::move(delta), mapper);
  const bool is_full_due = since_full_ >= full_map_every_ && topics_.full.matched() > 0;
  if (is_full_due && !is_busy()) return publish_all(mapper, keyframes_waiting);
  sender_.send(
      [this, info = info_of(mapper, keyframes_waiting, keyframe_.stamp_ns)] { topics_.info.write(info); });
}

void MapOutputs::publish_all(const SemanticMapper& mapper, std::size_t keyframes_waiting) {
  since_full_ = 0;
  full_stamp_ns_ = std::max(keyframe_.stamp_ns, full_stamp_ns_ + 1);
  views_ = {mapper.map().revision, Clock::now()};
  send_large([this, stamp = full_stamp_ns_, info = info_of(mapper, keyframes_waiting, full_stamp_ns_),
              snapshot = std::make_shared<MapSnapshot>(take_snapshot(mapper))]() mutable {
    const auto started = Clock::now();
    const auto tree = tree_of(*snapshot);
    write_full(*tree, *snapshot, info, stamp);
    write_views(*tree, *snapshot, stamp);
    const std::chrono::duration<double, std::milli> took = Clock::now() - started;
    full_map_latency_.add_ms(took.count());
  });
}

bool MapOutputs::has_viewers() const {
  return topics_.objects.matched() + topics_.markers.matched() + grid_.matched() + topics_.binary.matched() +
             topics_.points.matched() >
         0;
}

void MapOutputs::refresh_views(const SemanticMapper& mapper) {
  if (Clock::now() - views_.made < kViewPeriod || is_busy() || !has_viewers()) return;
  if (mapper.map().revision == views_.revision && !grid_.owes_whole()) return;
  views_ = {mapper.map().revision, Clock::now()};
  send_large(
      [this, stamp = keyframe_.stamp_ns, snapshot = std::make_shared<MapSnapshot>(take_snapshot(mapper))] {
        write_views(*tree_of(*snapshot), *snapshot, stamp);
      });
}

void MapOutputs::make_grid_message(const SemanticMapper& mapper,
                                   std::function<void(nav_msgs::msg::OccupancyGrid&&)> take) {
  send_large([this, stamp = keyframe_.stamp_ns, take = std::move(take),
              snapshot = std::make_shared<MapSnapshot>(take_snapshot(mapper))] {
    take(of_robot(grid_message(make_grid(*tree_of(*snapshot), snapshot->up, grid_config_), stamp),
                  frame_prefix_));
  });
}

void MapOutputs::make_octomap_message(const SemanticMapper& mapper, bool binary,
                                      std::function<void(octomap_msgs::msg::Octomap&&)> take) {
  send_large([this, binary, stamp = keyframe_.stamp_ns, take = std::move(take),
              snapshot = std::make_shared<MapSnapshot>(take_snapshot(mapper))] {
    take(of_robot(binary ? binary_message(*tree_of(*snapshot), stamp) : full_message(*snapshot, stamp),
                  frame_prefix_));
  });
}

void MapOutputs::send_large(std::function<void()> write) {
  ++large_under_way_;
  sender_.send([this, write = std::move(write)] {
    const std::shared_ptr<void> done(nullptr, [this](void*) { --large_under_way_; });
    write();
  });
}

void MapOutputs::write_full(const octomap::ColorOcTree& tree, const MapSnapshot& snapshot,
                            rds_msgs::msg::MapInfo& info, std::int64_t stamp_ns) {
  LabelRows hidden = labels_not_shown_by_colors(tree, snapshot);
  info.describes_full(true);
  info.label_keys(std::move(hidden.keys));
  info.label_values(std::move(hidden.values));
  topics_.full.write(of_robot(full_message(snapshot, stamp_ns), frame_prefix_));
  topics_.info.write(info);
}

void MapOutputs::write_views(const octomap::ColorOcTree& tree, const MapSnapshot& snapshot,
                             std::int64_t stamp_ns) {
  topics_.objects.write(of_robot(objects_message(snapshot.objects, stamp_ns), frame_prefix_));
  topics_.markers.write(of_robot(markers_message(snapshot.objects, stamp_ns), frame_prefix_));
  grid_.write(of_robot(grid_message(make_grid(tree, snapshot.up, grid_config_), stamp_ns), frame_prefix_));
  if (topics_.binary.matched() > 0)
    topics_.binary.write(of_robot(binary_message(tree, stamp_ns), frame_prefix_));
  if (topics_.points.matched() > 0)
    topics_.points.write(of_robot(points_message(points_of(tree, snapshot), stamp_ns), frame_prefix_));
}

}  // namespace rds::mapper
