// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "services/mapper/core/octree/octree_replica.hpp"
#include "services/viewer/core/frames/frame.hpp"
#include "services/viewer/core/map/changed_chunks.hpp"

namespace rds::viewer {

/// How much of the map a client has.
struct MapCursor {
  std::uint64_t generation = 0;  // of the map; another one: nothing of it
  std::uint64_t sequence = 0;    // all changes up to this one
  bool complete = false;         // it was told that it has all
};

/// The occupied voxels of the map as clients are sent them, chunk by chunk, each with the number of its last
/// change. So what a client lacks, however far it is behind, is each changed chunk once, as it is now.
class MapChunks {
 public:
  /// A frame ends with the chunk that reaches this size, so that what waits for a client is bounded and the
  /// first part of a large map shows at once.
  static constexpr std::size_t kFrameBytes = 512 * 1024;

  /// Takes over what has changed in the map. A map of another id replaces all.
  void show(const mapper::OctreeReplica& map, const ChangedChunks& changed);

  /// The next part of what a client lacks, and advances its cursor; nullopt if it lacks nothing.
  [[nodiscard]] std::optional<Bytes> next(MapCursor& cursor) const;

  [[nodiscard]] std::uint64_t voxels() const { return voxels_; }  // occupied
  [[nodiscard]] std::uint64_t revision() const { return revision_; }

 private:
  struct Chunk {
    std::uint64_t sequence = 0;
    Bytes bytes;  // with its header
  };

  void show_all(const mapper::OctreeReplica& map);
  void put(std::uint64_t chunk, Bytes bytes);

  std::map<std::uint64_t, Chunk> chunks_;               // empty ones, too: clients may have seen them full
  std::map<std::uint64_t, std::uint64_t> by_sequence_;  // chunk by the number of its last change
  std::uint64_t generation_ = 1;                        // 0 is that of a client without a map
  std::uint64_t sequence_ = 0;
  std::uint64_t map_epoch_ = 0;
  std::uint64_t map_id_ = 0;
  std::uint64_t revision_ = 0;
  std::uint64_t voxels_ = 0;
  double resolution_ = 0;
};

}  // namespace rds::viewer
