// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/scan/scan_grid.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace rds::mapper {
namespace {

/// One coordinate of a voxel on a ray; no branches, as nobody can predict which one is next to change.
struct RayAxis {
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  RayAxis(double from, double to)
      : key(static_cast<int>(std::floor(from))), left(static_cast<int>(std::floor(to)) - key) {
    step = left < 0 ? -1 : 1;
    left = std::abs(left);
    delta = 1 / std::abs(to - from);
    next = left == 0 ? kNever : std::abs(key + (step > 0 ? 1 : 0) - from) * delta;
  }
  void advance(bool go) {
    key += go ? step : 0;
    left -= go ? 1 : 0;
    next = left == 0 ? kNever : next + (go ? delta : 0);
  }

  int key;
  int left;      // steps
  int step;      // +1 or −1
  double delta;  // share of the ray from border to border
  double next;   // share of the ray up to the next border
};

}  // namespace

BlockMask ScanGrid::Block::cells(ScanFlag flag) const {
  static_assert(std::endian::native == std::endian::little);
  constexpr std::uint64_t kLowBits = 0x0101010101010101U;
  constexpr std::uint64_t kGather =
      0x0102040810204080U;  // brings the low bits of eight bytes into the highest
  const int bit = std::countr_zero(static_cast<unsigned>(flag));
  BlockMask cells;
  for (std::size_t i = 0; i < kBlockCells; i += 8) {
    std::uint64_t eight = 0;
    std::memcpy(&eight, &flags[i], 8);
    cells.word(i / 64) |= ((eight >> bit & kLowBits) * kGather >> 56U) << (i % 64);
  }
  return cells;
}

void ScanGrid::reset(const octomap::OcTreeKey& lowest, const octomap::OcTreeKey& highest) {
  std::size_t count = 1;
  for (unsigned axis = 0; axis < 3; ++axis) {
    first_block_[axis] = lowest[axis] >> kBlockBits;
    size_[axis] = (highest[axis] >> kBlockBits) - first_block_[axis] + 1;
    count *= static_cast<std::size_t>(size_[axis]);
  }
  index_.assign(count, -1);
  blocks_.clear();
}

ScanGrid::Block& ScanGrid::block_of(const octomap::OcTreeKey& key) {
  auto& index = index_[place_of(key[0], key[1], key[2])];
  if (index < 0) {
    index = static_cast<std::int32_t>(blocks_.size());
    auto& block = blocks_.emplace_back();
    block.key = block_key(key);
  }
  return blocks_[static_cast<std::size_t>(index)];
}

void ScanGrid::mark_beside(const octomap::OcTreeKey& key) {
  const auto from = [&](unsigned axis) { return std::max(key[axis] - 1, first_block_[axis] << kBlockBits); };
  const auto to = [&](unsigned axis) {
    return std::min(key[axis] + 1, ((first_block_[axis] + size_[axis]) << kBlockBits) - 1);
  };
  for (int z = from(2); z <= to(2); ++z)
    for (int y = from(1); y <= to(1); ++y)
      for (int x = from(0); x <= to(0); ++x) {
        const std::int32_t block = index_[place_of(x, y, z)];
        if (block < 0) continue;
        blocks_[static_cast<std::size_t>(block)]
            .flags[cell_of(static_cast<unsigned>(x), static_cast<unsigned>(y), static_cast<unsigned>(z))] |=
            kBesideSurface;
      }
}

void ScanGrid::cast_ray(const Eigen::Vector3d& from, const Eigen::Vector3d& to, ScanFlag flag) {
  RayAxis x(from.x(), to.x());
  RayAxis y(from.y(), to.y());
  RayAxis z(from.z(), to.z());
  Block* block = nullptr;
  int block_x = -1;  // a voxel of the block
  int block_y = -1;
  int block_z = -1;
  for (int steps = x.left + y.left + z.left; steps > 0; --steps) {
    if (((x.key ^ block_x) | (y.key ^ block_y) | (z.key ^ block_z)) >> kBlockBits != 0) {
      block_x = x.key;
      block_y = y.key;
      block_z = z.key;
      block = &block_of({static_cast<std::uint16_t>(x.key), static_cast<std::uint16_t>(y.key),
                         static_cast<std::uint16_t>(z.key)});
    }
    block->flags[cell_of(static_cast<unsigned>(x.key), static_cast<unsigned>(y.key),
                         static_cast<unsigned>(z.key))] |= flag;
    const bool go_x = (x.next <= y.next) & (x.next <= z.next);
    const bool go_y = !go_x & (y.next <= z.next);
    x.advance(go_x);
    y.advance(go_y);
    z.advance(!(go_x | go_y));
  }
}

}  // namespace rds::mapper
