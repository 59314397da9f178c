// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <span>

#include "services/mapper/core/evidence/evidence_block.hpp"

namespace rds::mapper {

/// What one keyframe, with one pose, contributes to the map.
struct Contribution {
  struct Surface {
    octomap::OcTreeKey key;
    SurfaceLook look;
  };
  KeyframeView view;
  std::vector<Surface> surfaces;  // static and doubtful voxels, each once
};

/// All that keyframes say of space. A map is a function of it: contributions may come, go and come again in
/// any order, at the cost of the blocks they touch.
class Evidence {
 public:
  /// @param apart_s  so much earlier or later is another time: something dynamic would have moved.
  explicit Evidence(double apart_s);
  /// Begins with what is known before all keyframes; before any other call.
  void begin_with(const FinalMap& known);

  /// @param keyframe  none of those that are there.
  void add(std::uint64_t keyframe, std::int64_t time_ns, Contribution contribution);
  /// @param surfaces  as they were added.
  void remove(std::uint64_t keyframe, std::span<const Contribution::Surface> surfaces);
  /// What a keyframe says stays as it is, before all that is not final. @param surfaces  as they were added.
  void make_final(std::uint64_t keyframe, std::span<const Contribution::Surface> surfaces);

  using Show = std::function<void(const octomap::OcTreeKey&, const EvidenceBlock&)>;
  /// Brings all blocks that contributions have touched since the last time up to date, and shows them. Of the
  /// keyframes whose surfaces others may confirm it looks at new ones and some others.
  /// @param show  (key of the block's lowest voxel, block), in order of first touch.
  void update(const Show& show);
  /// As update(), but looks at all keyframes: what is shown then is a function of the contributions.
  void update_all(const Show& show);

  [[nodiscard]] FinalMap final_map() const;
  /// nullptr where nothing is known.
  [[nodiscard]] const EvidenceBlock* block(const octomap::OcTreeKey& voxel) const;

 private:
  using BlockKey = std::uint64_t;
  struct Place {
    EvidenceBlock evidence;
    bool is_touched = false;
  };
  struct Keyframe {
    EvidenceTime time = 0;
    std::shared_ptr<KeyframeView> view;
  };
  EvidenceBlock& touch(BlockKey key);
  void judge(std::uint64_t id, Keyframe& keyframe);
  void show_touched(const Show& show);
  [[nodiscard]] EvidenceTime time_of(std::int64_t time_ns);

  EvidenceTime apart_;
  std::unordered_map<BlockKey, Place> blocks_;  // by key only: their order means nothing
  std::vector<BlockKey> touched_;
  std::map<std::uint64_t, Keyframe> keyframes_;
  std::vector<std::uint64_t> new_;  // keyframes that were not judged yet
  std::uint64_t judged_last_ = 0;   // keyframe
  std::optional<std::int64_t> origin_ms_;
};

}  // namespace rds::mapper
