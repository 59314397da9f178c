// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "common/map_file/byte_writer.hpp"
#include "services/tracker/core/map/slam_map.hpp"

namespace rds::tracker {

/// A row of a checkpoint; without bytes it is gone.
struct CheckpointRow {
  std::string kind;
  std::uint64_t id = 0;
  std::optional<map_file::Bytes> bytes;
};

/// Visits the rows of a kind by ascending id. @return or why they cannot be read.
using VisitRow = std::function<void(std::uint64_t id, std::span<const std::uint8_t> bytes)>;
using ReadRows = std::function<tl::expected<void, std::string>(const std::string& kind, const VisitRow&)>;

/// Writes a map as rows, each time those that may have changed.
///
/// "features", by keyframe, are written once: what its picture showed. "keyframes", by IdTable's block of
/// ids, hold stamps, poses, anchors of what was culled, and which features are movable by now; "points", by
/// block, positions, who sees them and how often they were found (written anew only where something else has
/// changed, too); "map", one row, are the next ids and what is in which submap. So a step costs what is around the camera, not the
/// whole map, and a camera that stands still in a place it knows costs nothing.
class MapCheckpoint {
 public:
  /// @param map  the same one each time; what it says of touched blocks is taken.
  void append_changes(SlamMap& map, std::vector<CheckpointRow>& rows);
  /// All rows of this map are written already.
  void mark_written(SlamMap& map);

 private:
  void append_features(const SlamMap& map, std::size_t block, std::vector<CheckpointRow>& rows);
  void append_points(const SlamMap& map, std::size_t block, std::vector<CheckpointRow>& rows);

  std::set<KeyframeId> with_features_;  // that have been written
  std::map<std::size_t, std::uint64_t>
      points_;  // checksums of the blocks that have been written, without counters
};

/// The map that rows tell of. Ids that the process before may have given since are used up.
/// @return or what is wrong with the rows.
tl::expected<SlamMap, std::string> map_from_rows(const ReadRows& read, const ScalePyramid& pyramid);

}  // namespace rds::tracker
