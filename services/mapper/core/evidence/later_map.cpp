// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/evidence/later_map.hpp"

#include <algorithm>
#include <set>

namespace rds::mapper {
namespace {

using geometry::Pose;
using octomap::OcTreeKey;

constexpr int kBlockSide = 1 << kBlockBits;

const FinalBlock* block_at(const FinalMap& map, std::uint64_t key) {
  const auto found = map.blocks.find(key);
  return found == map.blocks.end() ? nullptr : found->second.get();
}

/// A voxel as a map knows it.
struct Voxel {
  const FinalBlock* block = nullptr;  // nullptr: unknown
  std::uint16_t cell = 0;

  [[nodiscard]] bool is_known() const { return block != nullptr; }
  [[nodiscard]] LogOdds value() const { return block->occupancy.values[cell]; }
  [[nodiscard]] bool is_occupied() const { return is_known() && value() > 0; }
  [[nodiscard]] bool is_free() const { return is_known() && value() <= 0; }
  [[nodiscard]] VoxelLook look() const {
    const auto found = block->looks.find(cell);
    return found == block->looks.end() ? VoxelLook() : found->second;
  }
};

Voxel voxel_in(const FinalBlock* block, std::uint16_t cell) {
  return block != nullptr && block->occupancy.known.has(cell) ? Voxel{block, cell} : Voxel{};
}

/// Looks into a map at points; points near each other come one after the other.
class Sampler {
 public:
  Sampler(const FinalMap& map, double voxel_m) : map_(map), voxel_m_(voxel_m) {}

  Voxel at(const Eigen::Vector3d& point) {
    const OcTreeKey key = key_around(point, voxel_m_);
    if (const std::uint64_t block = packed(block_key(key)); block != block_key_) {
      block_key_ = block;
      block_ = block_at(map_, block);
    }
    return voxel_in(block_, cell_of(key));
  }

 private:
  const FinalMap& map_;
  double voxel_m_;
  std::uint64_t block_key_ = ~std::uint64_t{0};
  const FinalBlock* block_ = nullptr;
};

template <class Visit>
void for_each_corner(const Eigen::Vector3d& lowest, double side_m, Visit visit) {
  for (int i = 0; i < 8; ++i) visit(lowest + side_m * Eigen::Vector3d(i & 1, i >> 1 & 1, i >> 2));
}

/// Blocks of the earlier map's grid that blocks of the later one reach.
std::set<std::uint64_t> reached_blocks(const LaterMap& later, double voxel_m) {
  const double block_m = kBlockSide * voxel_m;
  std::set<std::uint64_t> reached;
  for (const auto& [key, block] : later.voxels.blocks) {
    const Eigen::Vector3d lowest = corner_of(unpacked(key), voxel_m);
    const Pose after_from_before =
        later.motion.after_from_before(lowest + Eigen::Vector3d::Constant(block_m / 2));
    Eigen::AlignedBox3d box;
    for_each_corner(lowest, block_m, [&](const Eigen::Vector3d& p) { box.extend(after_from_before * p); });
    const Eigen::Vector3d margin = Eigen::Vector3d::Constant(voxel_m);
    const OcTreeKey from = block_key(key_around(box.min() - margin, voxel_m));
    const OcTreeKey to = block_key(key_around(box.max() + margin, voxel_m));
    for (int x = from[0]; x <= to[0]; x += kBlockSide)
      for (int y = from[1]; y <= to[1]; y += kBlockSide)
        for (int z = from[2]; z <= to[2]; z += kBlockSide)
          reached.insert(packed(
              {static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), static_cast<std::uint16_t>(z)}));
  }
  return reached;
}

LogOdds in_sequence(LogOdds earlier, LogOdds later) {
  if (later == kLowest || later == kHighest) return later;
  return static_cast<LogOdds>(std::clamp(earlier + later, int{kLowest}, int{kHighest}));
}

/// Makes one block of both maps.
class BlockMerge {
 public:
  BlockMerge(const LaterMap& later, double voxel_m, VoxelChanges& changes)
      : later_(later), voxel_m_(voxel_m), sampler_(later.voxels, voxel_m), changes_(changes) {}

  FinalBlock merge(const FinalBlock* earlier, const OcTreeKey& key) {
    FinalBlock merged;
    const Eigen::Vector3d middle =
        corner_of(key, voxel_m_) + Eigen::Vector3d::Constant(kBlockSide * voxel_m_ / 2);
    before_from_after_ = later_.motion.before_from_after(middle);
    for (unsigned x = 0; x < kBlockSide; ++x)
      for (unsigned y = 0; y < kBlockSide; ++y)
        for (unsigned z = 0; z < kBlockSide; ++z) {
          const OcTreeKey voxel(static_cast<std::uint16_t>(key[0] + x),
                                static_cast<std::uint16_t>(key[1] + y),
                                static_cast<std::uint16_t>(key[2] + z));
          add(voxel_in(earlier, cell_of(voxel)), voxel, merged);
        }
    return merged;
  }

 private:
  void add(const Voxel& earlier, const OcTreeKey& key, FinalBlock& merged) {
    const Eigen::Vector3d lowest = corner_of(key, voxel_m_);
    const Voxel later = sampler_.at(before_from_after_ * (lowest + Eigen::Vector3d::Constant(voxel_m_ / 2)));
    const bool is_kept = earlier.is_occupied() && later.is_free() && !is_free_around(lowest);
    if (!earlier.is_known() && !later.is_known()) return;
    LogOdds value = earlier.is_known() ? earlier.value() : later.value();
    if (earlier.is_known() && later.is_known() && !is_kept) value = in_sequence(value, later.value());
    VoxelLook look;
    if (value > 0 && earlier.is_occupied()) look.add(earlier.look());
    if (value > 0 && later.is_occupied()) look.add(later.look().relabelled(later_.label_of));
    merged.add(cell_of(key), value, look);
    changes_.appeared += value > 0 && !earlier.is_occupied() ? 1 : 0;
    changes_.vanished += value <= 0 && earlier.is_occupied() ? 1 : 0;
  }

  /// Whether all of the later map that a voxel touches is free.
  bool is_free_around(const Eigen::Vector3d& lowest) {
    bool is_free = true;
    for_each_corner(lowest, voxel_m_, [&](const Eigen::Vector3d& p) {
      is_free = is_free && sampler_.at(before_from_after_ * p).is_free();
    });
    return is_free;
  }

  const LaterMap& later_;
  double voxel_m_;
  Sampler sampler_;
  VoxelChanges& changes_;
  Pose before_from_after_ = Pose::Identity();
};

}  // namespace

FinalMap add_later(const FinalMap& earlier, const LaterMap& later, double voxel_m, VoxelChanges& changes) {
  FinalMap merged = earlier;
  BlockMerge merge(later, voxel_m, changes);
  for (const std::uint64_t key : reached_blocks(later, voxel_m)) {
    FinalBlock block = merge.merge(block_at(earlier, key), unpacked(key));
    if (!block.occupancy.known.empty())
      merged.blocks[key] = std::make_shared<const FinalBlock>(std::move(block));
  }
  return merged;
}

}  // namespace rds::mapper
