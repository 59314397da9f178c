// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <string>

#include "common/service/service.hpp"
#include "rds_msgs/msg/MapInfo.h"
#include "services/mapper/grid/grid_publisher.hpp"
#include "services/mapper/map_messages.hpp"
#include "services/mapper/sender.hpp"
#include "services/mapper/sharing/map_sharing.hpp"

namespace rds::mapper {

/// A publisher of each topic that the mapper writes, but for the grid's.
struct MapPublishers {
  bus::Publisher<rds_msgs::msg::OctreeDelta> delta;
  bus::Publisher<octomap_msgs::msg::Octomap> full;
  bus::Publisher<octomap_msgs::msg::Octomap> binary;
  bus::Publisher<sensor_msgs::msg::PointCloud2> points;
  bus::Publisher<rds_msgs::msg::MapInfo> info;
  bus::Publisher<vision_msgs::msg::Detection3DArray> objects;
  bus::Publisher<visualization_msgs::msg::MarkerArray> markers;
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
  /// @param full_map_every  keyframes from one full map to the next, while somebody reads them.
  MapOutputs(service::ServiceContext& context, const GridConfig& grid, int full_map_every);

  /// Makes grids by another configuration from now on, one at once where somebody reads them.
  void reconfigure(const GridConfig& grid, int full_map_every);

  /// What follows is of another map: readers of the one before wait for the next full map.
  void begin_map();
  /// The newest keyframe that is in the map.
  void note_keyframe(std::uint64_t id, std::int64_t stamp_ns);

  void publish_delta(MapDelta delta, const SemanticMapper& mapper);
  /// A delta, and after it the full map where that is due and somebody reads it, else the MapInfo alone.
  /// @param keyframes_waiting  MapInfo tells how far the mapper is.
  void publish(MapDelta delta, const SemanticMapper& mapper, std::size_t keyframes_waiting);
  /// Full map, its MapInfo, objects, markers and grid (GridPublisher); binary map and points where somebody
  /// reads them.
  void publish_all(const SemanticMapper& mapper, std::size_t keyframes_waiting);
  /// What other programs look at (objects, markers, grid, binary map, points), where somebody does, the map
  /// has changed, and the last one is a second old. Called again and again.
  void refresh_views(const SemanticMapper& mapper);

  // The map as it is, for one who has asked; handed on from the thread that makes large messages.
  void make_grid_message(const SemanticMapper& mapper,
                         std::function<void(nav_msgs::msg::OccupancyGrid&&)> take);
  /// @param binary  as rds/map/binary, else as rds/map/full.
  void make_octomap_message(const SemanticMapper& mapper, bool binary,
                            std::function<void(octomap_msgs::msg::Octomap&&)> take);

  /// Where readers on other machines wait for the map: shares it as it is.
  void share_map(const SemanticMapper& mapper);
  /// True once after somebody new has subscribed to the map in any form.
  bool has_new_reader();
  /// True while a full map, or views of it, are on their way.
  [[nodiscard]] bool is_busy() const { return large_under_way_ > 0; }
  /// Returns when everything is out.
  void flush() { sender_.flush(); }

 private:
  [[nodiscard]] rds_msgs::msg::MapInfo info_of(const SemanticMapper& mapper, std::size_t keyframes_waiting,
                                               std::int64_t stamp_ns) const;
  /// @param tree  of the snapshot's nodes; this and below.
  void write_full(const octomap::ColorOcTree& tree, const MapSnapshot& snapshot, rds_msgs::msg::MapInfo& info,
                  std::int64_t stamp_ns);
  void write_views(const octomap::ColorOcTree& tree, const MapSnapshot& snapshot, std::int64_t stamp_ns);
  [[nodiscard]] bool has_viewers() const;
  /// On the sender's thread, while is_busy().
  void send_large(std::function<void()> write);

  struct Newest {
    std::uint64_t id = 0;
    std::int64_t stamp_ns = 0;
  };
  struct Views {
    std::uint64_t revision = 0;  // that they show
    std::chrono::steady_clock::time_point made = {};
  };

  GridConfig grid_config_;  // the sender's thread's
  int full_map_every_;
  std::uint64_t instance_;
  std::string frame_prefix_;
  std::uint64_t map_id_;
  Newest keyframe_;
  std::int64_t full_stamp_ns_ = 0;  // of the newest full map
  int since_full_ = 0;              // keyframes
  Views views_;
  int readers_ = 0;
  std::atomic<int> large_under_way_ = 0;
  MapPublishers topics_;
  GridPublisher grid_;  // for the sender's thread, or, while not is_busy(), the worker's
  service::LatencyWindow& full_map_latency_;
  MapSharing sharing_;
  Sender sender_;  // last: its thread uses the members above
};

}  // namespace rds::mapper
