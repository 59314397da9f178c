// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/map_messages.hpp"

#include "common/messages/conversions.hpp"
#include "common/messages/detection_conversions.hpp"
#include "services/mapper/core/octree/tree_bytes.hpp"

namespace rds::mapper {
namespace {

using sensor_msgs::msg::PointField;
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
  const geometry::OrientedBox& box = object.upright.box;
  marker.pose(messages::to_pose_message(box.map_from_box));
  const Eigen::Vector3d scale = type == kCube ? box.size : Eigen::Vector3d(0, 0, kTextHeightM);
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

octomap_msgs::msg::Octomap octomap_message(const std::string& type, bool binary, double resolution_m,
                                           std::span<const std::uint8_t> bytes, std::int64_t stamp_ns) {
  octomap_msgs::msg::Octomap message;
  message.header(messages::make_header(stamp_ns, kMap));
  message.binary(binary);
  message.id(type);
  message.resolution(resolution_m);
  message.data().assign(bytes.begin(), bytes.end());
  return message;
}

PointField field(const std::string& name, std::uint32_t offset, std::uint8_t type) {
  PointField field;
  field.name(name);
  field.offset(offset);
  field.datatype(type);
  field.count(1);
  return field;
}

}  // namespace

rds_msgs::msg::OctreeDelta to_message(const MapDelta& delta) {
  rds_msgs::msg::OctreeDelta message;
  message.header(messages::make_header(delta.stamp_ns, kMap));
  message.map_epoch(delta.map_epoch);
  message.map_id(delta.map_id);
  message.base_revision(delta.base_revision);
  message.revision(delta.revision);
  message.keyframe_id(delta.keyframe_id);
  message.resolution(delta.resolution);
  message.keys(delta.keys);
  message.log_odds(delta.log_odds);
  message.labels(delta.labels);
  message.colors(delta.colors);
  message.deleted_keys(delta.deleted_keys);
  return message;
}

octomap_msgs::msg::Octomap full_message(const MapSnapshot& snapshot, std::int64_t stamp_ns) {
  return octomap_message("ColorOcTree", false, snapshot.resolution, snapshot.nodes, stamp_ns);
}

octomap_msgs::msg::Octomap binary_message(const octomap::ColorOcTree& tree, std::int64_t stamp_ns) {
  return octomap_message("OcTree", true, tree.getResolution(), to_binary_bytes(tree), stamp_ns);
}

sensor_msgs::msg::PointCloud2 points_message(const MapPoints& points, std::int64_t stamp_ns) {
  using sensor_msgs::msg::PointField_Constants::FLOAT32;
  sensor_msgs::msg::PointCloud2 message;
  message.header(messages::make_header(stamp_ns, kMap));
  message.height(1);
  message.width(points.count);
  message.fields({field("x", 0, FLOAT32), field("y", 4, FLOAT32), field("z", 8, FLOAT32),
                  field("rgb", 12, FLOAT32),
                  field("label", 16, sensor_msgs::msg::PointField_Constants::UINT32)});
  message.point_step(MapPoints::kRowBytes);
  message.row_step(MapPoints::kRowBytes * points.count);
  message.data(points.rows);
  message.is_dense(true);
  return message;
}

vision_msgs::msg::Detection3DArray objects_message(std::span<const MapObject> objects,
                                                   std::int64_t stamp_ns) {
  std::vector<messages::SpatialDetection> boxes;
  for (const MapObject& object : objects) {
    if (object.has_gone) continue;
    const auto score_of = [&](const LabelBelief& belief) {
      return static_cast<float>(double{object.score} * belief.probability);
    };
    messages::SpatialDetection& detection = boxes.emplace_back();
    detection.box = object.upright.box;
    detection.id = std::to_string(object.id);
    detection.label = object.label;
    detection.score = object.labels.empty() ? object.score : score_of(object.labels.front());
    for (std::size_t i = 1; i < object.labels.size(); ++i)
      detection.or_else.push_back({object.labels[i].label, score_of(object.labels[i])});
  }
  return messages::to_detection_message(boxes, messages::make_header(stamp_ns, kMap));
}

visualization_msgs::msg::MarkerArray markers_message(std::span<const MapObject> objects,
                                                     std::int64_t stamp_ns) {
  visualization_msgs::msg::MarkerArray message;
  visualization_msgs::msg::Marker clear;
  clear.header(messages::make_header(stamp_ns, kMap));
  clear.action(kDeleteAll);
  message.markers().push_back(clear);
  for (const MapObject& object : objects) {
    if (object.has_gone) continue;
    for (const std::int32_t type : {kCube, kText})
      message.markers().push_back(marker(object, stamp_ns, type));
  }
  return message;
}

nav_msgs::msg::OccupancyGrid grid_message(const OccupancyGrid& grid, std::int64_t stamp_ns) {
  nav_msgs::msg::OccupancyGrid message;
  message.header(messages::make_header(stamp_ns, kMap));
  message.info().map_load_time(messages::to_time(stamp_ns));
  message.info().resolution(static_cast<float>(grid.resolution));
  message.info().width(static_cast<std::uint32_t>(grid.width));
  message.info().height(static_cast<std::uint32_t>(grid.height));
  message.info().origin(messages::to_pose_message(grid.map_from_grid));
  message.data().assign(grid.data.begin(), grid.data.end());
  return message;
}

}  // namespace rds::mapper
