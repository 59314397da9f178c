// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "services/mapper/core/evidence/block_mask.hpp"

namespace rds::mapper {

/// What one keyframe says about a voxel; flags may be combined.
enum ScanFlag : std::uint8_t {
  kFreeSpace = 1,
  kSurface = 2,
  kRayCast = 4,
  kNoReturnRay = 8,
  kDynamicPlace = 16,
  kBesideSurface = 32,
};

/// Scratch volume of one keyframe: sparse blocks of 8×8×8 voxels, cells of a block in the octree's child
/// order, so that eight siblings are eight neighbouring bytes. Each voxel is marked once, however many pixels
/// and rays touch it.
class ScanGrid {
 public:
  struct Block {
    octomap::OcTreeKey key;  // of the block's lowest voxel
    std::array<std::uint8_t, kBlockCells> flags{};
    std::array<std::uint32_t, kBlockCells> slot;  // index of a surface voxel; valid where kSurface is set

    /// Cells that have a flag.
    [[nodiscard]] BlockMask cells(ScanFlag flag) const;
  };

  /// Empties the grid and makes it cover the keys from `lowest` to `highest`, both included.
  void reset(const octomap::OcTreeKey& lowest, const octomap::OcTreeKey& highest);

  /// Marks every voxel on the segment except the last one with `flag`.
  ///
  /// @param from, to  in voxel units: floor of a coordinate is the key; both inside the covered range.
  /// Source: Amanatides & Woo 1987; the number of steps is fixed beforehand, so that rounding cannot run
  /// away.
  void cast_ray(const Eigen::Vector3d& from, const Eigen::Vector3d& to, ScanFlag flag = kFreeSpace);

  Block& block_of(const octomap::OcTreeKey& key);

  /// Marks a voxel and its 26 neighbours, as far as they are in touched blocks, with kBesideSurface.
  void mark_beside(const octomap::OcTreeKey& key);

  /// Touched blocks in order of first touch.
  [[nodiscard]] const std::vector<Block>& blocks() const { return blocks_; }

 private:
  /// Of a voxel's block, in index_.
  [[nodiscard]] std::size_t place_of(int x, int y, int z) const {
    const auto along = [&](int key, unsigned axis) {
      return static_cast<std::size_t>((key >> kBlockBits) - first_block_[axis]);
    };
    return (along(z, 2) * static_cast<std::size_t>(size_[1]) + along(y, 1)) *
               static_cast<std::size_t>(size_[0]) +
           along(x, 0);
  }

  std::array<int, 3> first_block_{};
  std::array<int, 3> size_{};
  std::vector<std::int32_t> index_;  // of a block in blocks_, -1 if untouched
  std::vector<Block> blocks_;
};

}  // namespace rds::mapper
