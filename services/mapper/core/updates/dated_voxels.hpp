// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "services/mapper/core/octree/map_delta.hpp"

namespace rds::mapper {

/// The newest value of each voxel of a map, and the revision that set it. So what a reader lacks, however far
/// it is behind, is one delta with each voxel once.
class DatedVoxels {
 public:
  /// Begins with a whole map.
  /// @param whole  a delta from revision 0, as whole_map() gives it. The map's arrays must fit each other.
  explicit DatedVoxels(const MapDelta& whole);

  /// The next step of the map. @return false if it does not follow revision(): then nothing has changed.
  bool add(const MapDelta& delta);

  [[nodiscard]] std::uint64_t map_id() const { return head_.map_id; }
  [[nodiscard]] std::uint64_t revision() const { return head_.revision; }
  /// What turns the map of a revision into the newest one; from 0: all of it.
  /// @return nullopt from a revision that is none of this map's, or of which too much has been deleted since.
  [[nodiscard]] std::optional<MapDelta> since(std::uint64_t revision) const;

 private:
  struct Voxel {
    std::uint64_t morton = 0;
    std::uint64_t revision = 0;
    float log_odds = 0;
    std::uint16_t label = 0;
    std::array<std::uint8_t, 3> color{};
    bool is_deleted = false;
  };

  void set(const MapDelta& delta);
  void put(const Voxel& voxel);
  void insert_new();
  void forget_deleted();

  MapDelta head_;                        // without arrays: what is told of the newest step
  std::vector<Voxel> voxels_;            // by morton
  std::vector<Voxel> new_;               // of the step that is being added, where there was none
  std::size_t deleted_ = 0;              // among voxels_
  std::uint64_t deletions_known_since_;  // revision
};

}  // namespace rds::mapper
