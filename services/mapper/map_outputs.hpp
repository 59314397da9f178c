// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/service/service.hpp"
#include "nav_msgs/msg/OccupancyGrid.h"
#include "octomap_msgs/msg/Octomap.h"
#include "rds_msgs/msg/MapInfo.h"
#include "rds_msgs/msg/OctreeDelta.h"
#include "services/mapper/core/semantic_mapper.hpp"
#include "vision_msgs/msg/Detection3DArray.h"
#include "visualization_msgs/msg/MarkerArray.h"

namespace rds::mapper {

/// How far the mapper is, told with every MapInfo.
struct MapProgress {
  std::uint64_t last_keyframe_id = 0;
  std::uint64_t keyframes_waiting = 0;
};

/// All topics that the mapper writes.
///
/// The full map and the MapInfo that tells its epoch and revision carry the same stamp, and no two full maps
/// do. A reader that has both goes on with the deltas from that revision.
class MapOutputs {
 public:
  explicit MapOutputs(service::ServiceContext& context);

  void publish_delta(const MapDelta& delta);
  /// @param stamp_ns  of the newest keyframe, or of the full map that this describes.
  void publish_info(const SemanticMapper& mapper, const MapProgress& progress, std::int64_t stamp_ns);
  /// Full map, its MapInfo, objects, markers and grid.
  void publish_all(const SemanticMapper& mapper, const MapProgress& progress, std::int64_t stamp_ns);

  /// True once after somebody new has subscribed to the full map or the deltas.
  bool has_new_reader();

 private:
  void publish_full(const SemanticMapper& mapper);
  void publish_objects(const SemanticMapper& mapper);
  void publish_grid(const SemanticMapper& mapper);

  std::int64_t stamp_ns_ = 0;  // of the newest full map
  int readers_ = 0;
  bus::Publisher<rds_msgs::msg::OctreeDelta> delta_;
  bus::Publisher<octomap_msgs::msg::Octomap> full_;
  bus::Publisher<rds_msgs::msg::MapInfo> info_;
  bus::Publisher<vision_msgs::msg::Detection3DArray> objects_;
  bus::Publisher<visualization_msgs::msg::MarkerArray> markers_;
  bus::Publisher<nav_msgs::msg::OccupancyGrid> grid_;
};

}  // namespace rds::mapper
