// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/scan_grid.hpp"

#include <cmath>
#include <limits>

namespace rds::mapper {
namespace {

/// Bits of a local coordinate 0…7 spread to every third place: the octree's child order (x lowest).
constexpr std::array<std::uint16_t, 8> kSpread = {0, 1, 8, 9, 64, 65, 72, 73};

}  // namespace

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
  std::size_t at = 0;
  for (unsigned axis = 3; axis-- > 0;)
    at = at * static_cast<std::size_t>(size_[axis]) +
         static_cast<std::size_t>((key[axis] >> kBlockBits) - first_block_[axis]);
  auto& index = index_[at];
  if (index < 0) {
    index = static_cast<std::int32_t>(blocks_.size());
    auto& block = blocks_.emplace_back();
    for (unsigned axis = 0; axis < 3; ++axis)
      block.key[axis] = static_cast<std::uint16_t>(key[axis] & ~((1U << kBlockBits) - 1));
  }
  return blocks_[static_cast<std::size_t>(index)];
}

std::size_t ScanGrid::cell_of(const octomap::OcTreeKey& key) {
  return static_cast<std::size_t>(kSpread[key[0] & 7] | kSpread[key[1] & 7] << 1 | kSpread[key[2] & 7] << 2);
}

void ScanGrid::cast_ray(const Eigen::Vector3d& from, const Eigen::Vector3d& to, ScanFlag flag) {
  std::array<int, 3> key{};
  std::array<int, 3> step{};
  std::array<int, 3> left{};
  std::array<double, 3> t_next{};
  std::array<double, 3> t_step{};
  int steps = 0;
  for (unsigned axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    key[axis] = static_cast<int>(std::floor(from[a]));
    left[axis] = static_cast<int>(std::floor(to[a])) - key[axis];
    step[axis] = left[axis] < 0 ? -1 : 1;
    left[axis] = std::abs(left[axis]);
    steps += left[axis];
    t_step[axis] = 1 / std::abs(to[a] - from[a]);
    t_next[axis] = left[axis] == 0 ? std::numeric_limits<double>::infinity()
                                   : std::abs(key[axis] + (step[axis] > 0 ? 1 : 0) - from[a]) * t_step[axis];
  }
  Block* block = nullptr;
  int block_x = -1;
  int block_y = -1;
  int block_z = -1;
  for (; steps > 0; --steps) {
    if (key[0] >> kBlockBits != block_x || key[1] >> kBlockBits != block_y ||
        key[2] >> kBlockBits != block_z) {
      block_x = key[0] >> kBlockBits;
      block_y = key[1] >> kBlockBits;
      block_z = key[2] >> kBlockBits;
      block =
          &block_of(octomap::OcTreeKey(static_cast<std::uint16_t>(key[0]), static_cast<std::uint16_t>(key[1]),
                                       static_cast<std::uint16_t>(key[2])));
    }
    block->flags[static_cast<std::size_t>(kSpread[static_cast<std::size_t>(key[0] & 7)] |
                                          kSpread[static_cast<std::size_t>(key[1] & 7)] << 1 |
                                          kSpread[static_cast<std::size_t>(key[2] & 7)] << 2)] |= flag;
    const unsigned axis =
        t_next[0] <= t_next[1] ? (t_next[0] <= t_next[2] ? 0 : 2) : (t_next[1] <= t_next[2] ? 1 : 2);
    key[axis] += step[axis];
    t_next[axis] = --left[axis] == 0 ? std::numeric_limits<double>::infinity() : t_next[axis] + t_step[axis];
  }
}

}  // namespace rds::mapper
