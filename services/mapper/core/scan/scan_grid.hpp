// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
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
  kDynamicSurface = 64,
};

/// Cells of a block by their flags.
class FlaggedCells {
 public:
  explicit FlaggedCells(const std::array<std::uint8_t, kBlockCells>& flags);
  [[nodiscard]] const BlockMask& with(ScanFlag flag) const {
    return by_bit_[static_cast<std::size_t>(std::countr_zero(static_cast<unsigned>(flag)))];
  }

 private:
  std::array<BlockMask, 8> by_bit_;
};

/// Scratch volume of one keyframe: sparse blocks of 8×8×8 voxels, cells of a block in the octree's child
/// order, so that eight siblings are eight neighbouring bytes. Each voxel is marked once, however many pixels
/// and rays touch it.
class ScanGrid {
 public:
  struct Block {
    octomap::OcTreeKey key;  // of the block's lowest voxel
    std::array<std::uint8_t, kBlockCells> flags{};
  };

  /// Empties the grid and makes it cover the keys from `lowest` to `highest`, both included.
  void reset(const octomap::OcTreeKey& lowest, const octomap::OcTreeKey& highest);

  /// Marks every voxel on the segments to `ends`, except the last one of each, with `flag`.
  ///
  /// @param from, ends  in voxel units: floor of a coordinate is the key; all inside the covered range, and
  /// not on its border, as coordinates are rounded.
  /// Source: Amanatides & Woo 1987; deviation: axis by axis, not from voxel to voxel. The number of steps is
  /// fixed beforehand, so that rounding cannot run away.
  void cast_rays(const Eigen::Vector3d& from, std::span<const Eigen::Vector3d> ends,
                 ScanFlag flag = kFreeSpace);

  /// Of a voxel's block, in blocks(); made if there is none yet.
  std::size_t block_of(const octomap::OcTreeKey& key) { return block_at(place_of(key)); }
  std::uint8_t& flags_of(const octomap::OcTreeKey& key) { return flags_at(place_of(key)); }

  /// Marks a voxel and its 26 neighbours, as far as they are in touched blocks, with kBesideSurface.
  void mark_beside(const octomap::OcTreeKey& key);

  /// Touched blocks in order of first touch.
  [[nodiscard]] const std::vector<Block>& blocks() const { return blocks_; }

 private:
  /// Of a voxel: its block in index_ × kBlockCells + its cell. A sum over the axes of what each coordinate
  /// adds.
  using Place = std::size_t;
  /// Borders between voxels that a ray crosses along one axis.
  struct Crossings {
    unsigned axis;
    int before;  // coordinate along it before the first one
    int count;
    Eigen::Vector3d at;    // where the ray crosses the first one
    Eigen::Vector3d step;  // from there to the next one
  };
  struct Axis {
    int first = 0;              // coordinate
    int size = 0;               // a multiple of a block's side
    std::vector<Place> places;  // of coordinates from the first on

    [[nodiscard]] Place place(int coordinate) const {
      return places[static_cast<std::size_t>(coordinate - first)];
    }
  };
  [[nodiscard]] Place place_of(const octomap::OcTreeKey& key) const {
    return axes_[0].place(key[0]) + axes_[1].place(key[1]) + axes_[2].place(key[2]);
  }
  std::size_t block_at(Place place) {
    const std::int32_t block = index_[place / kBlockCells];
    return block >= 0 ? static_cast<std::size_t>(block) : add_block(place / kBlockCells);
  }
  std::uint8_t& flags_at(Place place) { return blocks_[block_at(place)].flags[place % kBlockCells]; }
  std::size_t add_block(std::size_t at);
  void cast_ray(const Eigen::Vector3d& from, const Eigen::Vector3d& to, ScanFlag flag);
  void mark_behind_borders(const Crossings& of, ScanFlag flag);

  static constexpr unsigned kFractionBits = 46;  // of coordinates with a fixed point; 17 are left for keys
  static constexpr double kOne = std::int64_t{1} << kFractionBits;

  std::array<Axis, 3> axes_;
  std::vector<std::int32_t> index_;  // of a block in blocks_, -1 if untouched
  std::vector<Block> blocks_;
};

}  // namespace rds::mapper
