// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

#include "common/service/service.hpp"
#include "rds_msgs/msg/MapInfo.h"
#include "services/mapper/map_messages.hpp"
#include "services/mapper/sender.hpp"

namespace rds::mapper {

/// How far the mapper is, told with every MapInfo.
struct MapProgress {
  std::uint64_t last_keyframe_id = 0;
  std::uint64_t keyframes_waiting = 0;
};

/// All topics that the mapper writes, in the order of the calls; large messages are made on a thread of their
/// own.
///
/// The full map and the MapInfo that tells its epoch, map id and revision carry the same stamp, and no two
/// full maps do. A reader that has both goes on with the deltas from that revision. MapInfo
/// has a deeper history than the full map, so that one that only says how far the mapper is does not displace
/// one that a reader still needs.
class MapOutputs {
 public:
  MapOutputs(service::ServiceContext& context, const GridConfig& grid);

  /// What follows is of another map: readers of the one before wait for the next full map.
  void begin_map();

  void publish_delta(MapDelta delta);
  /// @param stamp_ns  of the newest keyframe.
  void publish_info(const SemanticMapper& mapper, const MapProgress& progress, std::int64_t stamp_ns);
  /// Full map, its MapInfo, objects, markers and grid; binary map and points where somebody reads them.
  void publish_all(const SemanticMapper& mapper, const MapProgress& progress, std::int64_t stamp_ns);

  /// True once after somebody new has subscribed to the map in any form.
  bool has_new_reader();
  /// True while a full map is on its way.
  [[nodiscard]] bool is_busy() const { return full_maps_under_way_ > 0; }
  /// Returns when everything is out.
  void flush() { sender_.flush(); }

 private:
  [[nodiscard]] rds_msgs::msg::MapInfo info_of(const SemanticMapper& mapper, const MapProgress& progress,
                                               std::int64_t stamp_ns) const;
  void write_all(const MapSnapshot& snapshot, rds_msgs::msg::MapInfo& info, std::int64_t stamp_ns);

  GridConfig grid_config_;
  std::uint64_t instance_;
  std::uint64_t map_id_;
  std::int64_t stamp_ns_ = 0;  // of the newest full map
  int readers_ = 0;
  std::atomic<int> full_maps_under_way_ = 0;
  bus::Publisher<rds_msgs::msg::OctreeDelta> delta_;
  bus::Publisher<octomap_msgs::msg::Octomap> full_;
  bus::Publisher<octomap_msgs::msg::Octomap> binary_;
  bus::Publisher<sensor_msgs::msg::PointCloud2> points_;
  bus::Publisher<rds_msgs::msg::MapInfo> info_;
  bus::Publisher<vision_msgs::msg::Detection3DArray> objects_;
  bus::Publisher<visualization_msgs::msg::MarkerArray> markers_;
  bus::Publisher<nav_msgs::msg::OccupancyGrid> grid_;
  service::LatencyWindow& full_map_latency_;
  Sender sender_;  // last: its thread uses the members above
};

}  // namespace rds::mapper
