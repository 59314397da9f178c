// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/map_outputs.hpp"

#include <algorithm>

#include "common/messages/conversions.hpp"
#include "common/messages/detection_conversions.hpp"
#include "services/mapper/core/tree_bytes.hpp"

namespace rds::mapper {
namespace {

const std::string kMap = "map";
constexpr std::int32_t kCube = 1;
constexpr std::int32_t kText = 9;
constexpr std::int32_t kDeleteAll = 3;
constexpr float kMarkerOpacity = 0.4F;
constexpr double kTextHeightM = 0.12;

visualization_msgs::msg::Marker marker(const MapObject& object, std::int64_t stamp_ns, std::int32_t type) {
  visualization_msgs::msg::Marker marker;
  marker.header(messages::make_header(stamp_ns, kMap));
  marker.ns(type == kCube ? "objects" : "labels");
  marker.id(static_cast<std::int32_t>(object.id));
  marker.type(type);
  geometry::Pose pose = geometry::Pose::Identity();
  pose.translation() = object.center;
  marker.pose(messages::to_pose_message(pose));
  const Eigen::Vector3d scale = type == kCube ? object.size : Eigen::Vector3d(0, 0, kTextHeightM);
  marker.scale().x(scale.x());
  marker.scale().y(scale.y());
  marker.scale().z(scale.z());
  const Rgb color = label_color(object.label);
  marker.color().r(static_cast<float>(color[0]) / 255);
  marker.color().g(static_cast<float>(color[1]) / 255);
  marker.color().b(static_cast<float>(color[2]) / 255);
  marker.color().a(type == kCube ? kMarkerOpacity : 1.0F);
  if (type == kText) marker.text(object.label);
  return marker;
}

std::size_t count_occupied(const octomap::ColorOcTree& tree) {
  std::size_t occupied = 0;
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf)
    occupied += tree.isNodeOccupied(*leaf) ? 1U : 0U;
  return occupied;
}

}  // namespace

MapOutputs::MapOutputs(service::ServiceContext& context)
    : delta_(context.bus.advertise<rds_msgs::msg::OctreeDelta>("rds/map/delta", bus::kDelta)),
      full_(context.bus.advertise<octomap_msgs::msg::Octomap>("rds/map/full", bus::kLatched)),
      info_(context.bus.advertise<rds_msgs::msg::MapInfo>("rds/map/info", bus::kLatched)),
      objects_(context.bus.advertise<vision_msgs::msg::Detection3DArray>("rds/map/objects", bus::kLatched)),
      markers_(context.bus.advertise<visualization_msgs::msg::MarkerArray>("rds/map/markers", bus::kLatched)),
      grid_(context.bus.advertise<nav_msgs::msg::OccupancyGrid>("rds/map/grid", bus::kLatched)) {}

bool MapOutputs::has_new_reader() {
  const int readers = full_.matched() + delta_.matched();
  const bool more = readers > readers_;
  readers_ = readers;
  return more;
}

void MapOutputs::publish_delta(const MapDelta& delta) {
  if (delta.is_noop()) return;
  rds_msgs::msg::OctreeDelta message;
  message.header(messages::make_header(delta.stamp_ns, kMap));
  message.map_epoch(delta.map_epoch);
  message.base_revision(delta.base_revision);
  message.revision(delta.revision);
  message.keyframe_id(delta.keyframe_id);
  message.resolution(delta.resolution);
  message.keys(delta.keys);
  message.log_odds(delta.log_odds);
  message.labels(delta.labels);
  message.colors(delta.colors);
  message.deleted_keys(delta.deleted_keys);
  delta_.write(message);
}

void MapOutputs::publish_info(const SemanticMapper& mapper, const MapProgress& progress,
                              std::int64_t stamp_ns) {
  rds_msgs::msg::MapInfo info;
  info.header(messages::make_header(stamp_ns, kMap));
  info.map_epoch(mapper.map_epoch());
  info.revision(mapper.revision());
  const octomap::ColorOcTree& tree = mapper.tree();
  info.resolution(tree.getResolution());
  info.node_count(tree.size());
  info.occupied_count(count_occupied(tree));
  if (tree.size() > 0) {
    tree.getMetricMin(info.bounds_min()[0], info.bounds_min()[1], info.bounds_min()[2]);
    tree.getMetricMax(info.bounds_max()[0], info.bounds_max()[1], info.bounds_max()[2]);
  }
  info.labels(mapper.labels().names());
  info.keyframes_integrated(mapper.keyframes());
  info.last_keyframe_id(progress.last_keyframe_id);
  info.keyframes_waiting(progress.keyframes_waiting);
  info_.write(info);
}

void MapOutputs::publish_all(const SemanticMapper& mapper, const MapProgress& progress,
                             std::int64_t stamp_ns) {
  stamp_ns_ = std::max(stamp_ns, stamp_ns_ + 1);
  publish_full(mapper);
  publish_info(mapper, progress, stamp_ns_);
  publish_objects(mapper);
  publish_grid(mapper);
}

void MapOutputs::publish_full(const SemanticMapper& mapper) {
  const std::vector<std::uint8_t> bytes = to_bytes(mapper.tree());
  octomap_msgs::msg::Octomap message;
  message.header(messages::make_header(stamp_ns_, kMap));
  message.binary(false);
  message.id("ColorOcTree");
  message.resolution(mapper.tree().getResolution());
  message.data().assign(bytes.begin(), bytes.end());
  full_.write(message);
}

void MapOutputs::publish_objects(const SemanticMapper& mapper) {
  std::vector<messages::SpatialDetection> boxes;
  visualization_msgs::msg::MarkerArray markers;
  visualization_msgs::msg::Marker clear;
  clear.header(messages::make_header(stamp_ns_, kMap));
  clear.action(kDeleteAll);
  markers.markers().push_back(clear);
  for (const MapObject& object : mapper.objects()) {
    geometry::OrientedBox box;
    box.map_from_box.translation() = object.center;
    box.size = object.size;
    boxes.push_back({object.label, object.score, box, std::to_string(object.id)});
    markers.markers().push_back(marker(object, stamp_ns_, kCube));
    markers.markers().push_back(marker(object, stamp_ns_, kText));
  }
  objects_.write(messages::to_detection_message(boxes, messages::make_header(stamp_ns_, kMap)));
  markers_.write(markers);
}

void MapOutputs::publish_grid(const SemanticMapper& mapper) {
  const OccupancyGrid grid = mapper.grid();
  nav_msgs::msg::OccupancyGrid message;
  message.header(messages::make_header(stamp_ns_, kMap));
  message.info().map_load_time(messages::to_time(stamp_ns_));
  message.info().resolution(static_cast<float>(grid.resolution));
  message.info().width(static_cast<std::uint32_t>(grid.width));
  message.info().height(static_cast<std::uint32_t>(grid.height));
  message.info().origin(messages::to_pose_message(grid.map_from_grid));
  message.data().assign(grid.data.begin(), grid.data.end());
  grid_.write(message);
}

}  // namespace rds::mapper
