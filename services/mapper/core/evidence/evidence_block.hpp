// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <memory>
#include <memory_resource>
#include <optional>
#include <utility>
#include <vector>

#include "services/mapper/core/evidence/block_looks.hpp"
#include "services/mapper/core/evidence/final_map.hpp"
#include "services/mapper/core/evidence/keyframe_view.hpp"

namespace rds::mapper {

/// All evidence about 8×8×8 voxels, and what follows from it.
///
/// The occupancy after some of its keyframes is kept now and then along the list, the denser the nearer to
/// its end: where a keyframe comes or goes, only those behind it are added up again.
class EvidenceBlock {
 public:
  /// The observations of one keyframe about this block.
  struct Entry {
    std::uint64_t keyframe = 0;
    EvidenceTime time = 0;
    std::uint32_t block = 0;                   // of the view
    std::shared_ptr<const KeyframeView> view;  // nullptr: it has gone

    [[nodiscard]] bool has_sightings() const { return view && view->has_sightings(block); }
  };
  /// A keyframe's place in the list: by time, of equal ones by id.
  struct Rank {
    EvidenceTime time = 0;
    std::uint64_t keyframe = 0;
    auto operator<=>(const Rank&) const = default;
  };

  /// @param memory  of what it holds.
  explicit EvidenceBlock(std::pmr::memory_resource* memory = std::pmr::get_default_resource())
      : entries_(memory), looks_(memory), prefixes_(memory) {}

  void add(Entry entry);
  void remove(const Rank& rank);
  /// What is known of the block before all keyframes; before any other call.
  void begin_with(std::shared_ptr<const FinalBlock> known);
  /// What a keyframe said stays as it is now.
  void make_final(const Rank& rank);

  /// Of all keyframes.
  const BlockCounts& counts();
  /// A verdict on a surface of a keyframe has changed.
  void outdate(const Rank& rank);
  /// Keyframes that update() has to add up.
  [[nodiscard]] std::size_t not_added_up() const;
  /// Brings the occupancy up to date.
  void update();
  /// Adds the keyframes newer than all others to the occupancy as it is, where update() would take long.
  void add_newest();

  [[nodiscard]] const BlockOccupancy& occupancy() const { return occupancy_; }
  /// Voxels of which occupancy or look are others than at the last call.
  BlockMask take_changed() { return std::exchange(changed_, {}); }
  /// Of a cell; nullptr if no keyframe has seen a surface there.
  [[nodiscard]] const VoxelLook* look(std::uint16_t cell) const { return looks_.find(cell); }
  [[nodiscard]] const std::shared_ptr<const FinalBlock>& final_part() const { return final_; }
  /// Whether nothing is known of it.
  [[nodiscard]] bool empty() const { return entries_.empty() && !final_; }

 private:
  /// The occupancy after the first so many entries.
  struct Prefix {
    std::size_t entries = 0;
    BlockOccupancy occupancy;
  };

  [[nodiscard]] std::size_t at_or_after(const Rank& rank) const;
  [[nodiscard]] std::optional<std::size_t> find(const Rank& rank) const;
  void change_from(std::size_t entry);
  void close_gaps();
  void keep_prefix(std::size_t entries);

  std::pmr::vector<Entry>
      entries_;  // by rank; what goes leaves a gap until the next update(), for it may come back
  bool has_gaps_ = false;
  BlockLooks looks_;                         // with the final ones
  std::shared_ptr<const FinalBlock> final_;  // shared with the saved map; nullptr: none
  std::shared_ptr<BlockCounts> counts_;      // nullptr: nobody has asked yet
  BlockOccupancy occupancy_;
  std::size_t added_up_ = 0;                 // the first so many entries are in occupancy_; the rest is new
  std::optional<std::size_t> changed_from_;  // of these, the first that is not as it was added up
  std::pmr::vector<Prefix> prefixes_;        // by entries
  BlockMask changed_;
};

}  // namespace rds::mapper
