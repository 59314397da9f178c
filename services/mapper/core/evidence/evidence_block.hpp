// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <unordered_map>
#include <vector>

#include "services/mapper/core/evidence/final_map.hpp"
#include "services/mapper/core/evidence/keyframe_view.hpp"

namespace rds::mapper {

/// All evidence about 8×8×8 voxels, and what follows from it.
class EvidenceBlock {
 public:
  /// The observations of one keyframe about this block.
  struct Entry {
    std::uint64_t keyframe = 0;
    EvidenceTime time = 0;
    std::shared_ptr<const KeyframeView> view;
    std::uint32_t block = 0;  // of the view
  };

  void add(const Entry& entry);
  void remove(std::uint64_t keyframe);
  void add_look(std::uint16_t cell, const SurfaceLook& look) { looks_[cell].add(look); }
  void remove_look(std::uint16_t cell, const SurfaceLook& look);
  /// What is known of the block before all keyframes; before any other call.
  void begin_with(const FinalBlock& known);
  /// What a keyframe said stays as it is now. @param looks  of it, in this block.
  void make_final(std::uint64_t keyframe, const std::vector<std::pair<std::uint16_t, SurfaceLook>>& looks);

  /// Of all keyframes.
  const BlockCounts& counts();
  /// A verdict on a surface of a keyframe has changed.
  void outdate(std::uint64_t keyframe);
  /// Brings the log-odds up to date.
  void update();

  [[nodiscard]] const BlockLogOdds& log_odds() const { return log_odds_; }
  /// Of a cell; nullptr if no keyframe has seen a surface there.
  [[nodiscard]] const VoxelLook* look(std::uint16_t cell) const {
    const auto found = looks_.find(cell);
    return found == looks_.end() ? nullptr : &found->second;
  }
  [[nodiscard]] const FinalBlock* final_part() const { return final_.get(); }
  /// Whether nothing is known of it.
  [[nodiscard]] bool empty() const { return entries_.empty() && !final_; }

 private:
  using Entries = std::vector<Entry>;

  void add_up_all();
  void add_up_new();
  void add_to(BlockLogOdds& log_odds, const Entry& entry) const;
  [[nodiscard]] Entries::iterator at_or_after(std::uint64_t keyframe);
  [[nodiscard]] bool is_added_up(Entries::const_iterator entry) const { return entry < first_new(); }
  [[nodiscard]] Entries::const_iterator first_new() const {
    return entries_.begin() + static_cast<std::ptrdiff_t>(added_up_);
  }

  Entries entries_;                                     // by keyframe
  std::unordered_map<std::uint16_t, VoxelLook> looks_;  // by cell, with the final ones
  std::unique_ptr<FinalBlock> final_;
  std::unique_ptr<BlockCounts> counts_;  // nullptr: they have to be made again, or all are 0
  bool is_equivocal_ = false;            // verdicts on voxels matter
  BlockLogOdds log_odds_;
  std::unique_ptr<BlockVerdicts> verdicts_;  // with which log_odds_ was made, where they matter
  std::size_t added_up_ = 0;                 // the first so many entries are in log_odds_; the rest is new
  bool is_outdated_ = false;                 // all has to be added up again
};

}  // namespace rds::mapper
