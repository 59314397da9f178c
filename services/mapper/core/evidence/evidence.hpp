// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory_resource>
#include <unordered_map>

#include "services/mapper/core/evidence/evidence_block.hpp"

namespace rds::mapper {

/// All that keyframes say of space. A map is a function of it: contributions may come, go and come again in
/// any order, at the cost of the blocks they touch.
class Evidence {
 public:
  /// @param apart_s  so much earlier or later is another time: something dynamic would have moved.
  /// @param memory  of nearly all that it holds, in pieces of some pages; only what is near the keyframes that
  /// come, go or are judged is read and written.
  explicit Evidence(double apart_s, std::pmr::memory_resource* memory = std::pmr::get_default_resource());
  /// Begins with what is known before all keyframes; before any other call.
  void begin_with(const FinalMap& known);

  /// @param keyframe  none of those that are there.
  void add(std::uint64_t keyframe, std::int64_t time_ns, const KeyframeView& contribution);
  void remove(std::uint64_t keyframe);
  /// What a keyframe says stays as it is, before all that is not final.
  void make_final(std::uint64_t keyframe);

  using Show = std::function<void(const octomap::OcTreeKey&, const EvidenceBlock&, const BlockMask& changed)>;
  /// Brings the blocks that contributions have touched since the last time up to date, and shows them. Where
  /// that would take long, as after corrections of keyframes of long ago, some of it is left to the next
  /// times; new keyframes show at once. Of the keyframes whose surfaces others may confirm it looks at new
  /// ones and some others.
  /// @param show  (key of the block's lowest voxel, block, its voxels that may have changed).
  void update(const Show& show);
  /// As update(), but looks at all keyframes, and leaves nothing: what is shown then is a function of the
  /// contributions.
  void update_all(const Show& show);
  /// Whether update() has left something.
  [[nodiscard]] bool is_behind() const { return !behind_.empty(); }

  [[nodiscard]] FinalMap final_map() const;
  /// nullptr where nothing is known.
  [[nodiscard]] const EvidenceBlock* block(const octomap::OcTreeKey& voxel) const;

 private:
  using BlockKey = std::uint64_t;
  struct Place {
    explicit Place(std::pmr::memory_resource* memory) : evidence(memory) {}

    EvidenceBlock evidence;
    bool is_touched = false;
    bool is_behind = false;
  };
  struct Keyframe {
    EvidenceTime time = 0;
    std::shared_ptr<KeyframeView> view;
  };
  EvidenceBlock& touch(BlockKey key);
  void judge(std::uint64_t id, Keyframe& keyframe);
  void show_touched(std::size_t limit, const Show& show);
  std::size_t catch_up(BlockKey key, const Show& show);
  void show_block(BlockKey key, const Show& show);
  [[nodiscard]] EvidenceTime time_of(std::int64_t time_ns);

  EvidenceTime apart_;
  std::pmr::unsynchronized_pool_resource memory_;
  std::pmr::unordered_map<BlockKey, Place> blocks_{&memory_};  // by key only: their order means nothing
  std::vector<BlockKey> touched_;
  std::deque<BlockKey> behind_;  // those that have waited longest first; some may have gone
  std::map<std::uint64_t, Keyframe> keyframes_;
  std::vector<std::uint64_t> new_;  // keyframes that were not judged yet
  std::uint64_t judged_last_ = 0;   // keyframe
  std::optional<std::int64_t> origin_ms_;
};

}  // namespace rds::mapper
