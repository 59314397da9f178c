// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/scan/scan_grid.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace rds::mapper {
namespace {

constexpr int kSide = 1 << kBlockBits;
constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

/// Of an 8×8 matrix of bits, a byte for each row.
std::uint64_t transposed(std::uint64_t rows) {
  const auto swap = [&](unsigned shift, std::uint64_t mask) {
    const std::uint64_t bits = (rows ^ rows >> shift) & mask;
    rows ^= bits ^ bits << shift;
  };
  swap(7, 0x00AA00AA00AA00AA);
  swap(14, 0x0000CCCC0000CCCC);
  swap(28, 0x00000000F0F0F0F0);
  return rows;
}

}  // namespace

FlaggedCells::FlaggedCells(const std::array<std::uint8_t, kBlockCells>& flags) {
  static_assert(std::endian::native == std::endian::little);
  for (std::size_t cell = 0; cell < kBlockCells; cell += 8) {
    std::uint64_t eight = 0;
    std::memcpy(&eight, &flags[cell], 8);
    if (eight == 0) continue;
    eight = transposed(eight);
    for (std::size_t bit = 0; bit < by_bit_.size(); ++bit)
      by_bit_[bit].word(cell / 64) |= (eight >> 8 * bit & 0xFFU) << cell % 64;
  }
}

void ScanGrid::reset(const octomap::OcTreeKey& lowest, const octomap::OcTreeKey& highest) {
  std::size_t blocks = 1;
  for (unsigned i = 0; i < 3; ++i) {
    Axis& axis = axes_[i];
    axis.first = lowest[i] / kSide * kSide;
    axis.size = (highest[i] / kSide + 1) * kSide - axis.first;
    const auto size = static_cast<std::size_t>(axis.size);
    axis.places.resize(size);
    for (std::size_t at = 0; at < size; ++at)
      axis.places[at] = at / kSide * blocks * kBlockCells + cell_along(i, static_cast<unsigned>(at));
    for (auto& crossings : axis.crossings) crossings.resize(size + 1);
    blocks *= size / kSide;
  }
  index_.assign(blocks, -1);
  blocks_.clear();
}

std::size_t ScanGrid::add_block(std::size_t at) {
  index_[at] = static_cast<std::int32_t>(blocks_.size());
  auto& block = blocks_.emplace_back();
  for (unsigned i = 0; i < 3; ++i) {
    const auto along = static_cast<std::size_t>(axes_[i].size / kSide);
    block.key[i] = static_cast<std::uint16_t>(axes_[i].first + static_cast<int>(at % along) * kSide);
    at /= along;
  }
  return blocks_.size() - 1;
}

void ScanGrid::mark_beside(const octomap::OcTreeKey& key) {
  std::array<std::array<Place, 3>, 3> places;  // by axis
  std::array<std::size_t, 3> count{};
  for (unsigned i = 0; i < 3; ++i)
    for (int at = std::max(key[i] - 1, axes_[i].first); at <= key[i] + 1; ++at)
      if (at < axes_[i].first + axes_[i].size) places[i][count[i]++] = axes_[i].place(at);
  for (std::size_t z = 0; z < count[2]; ++z)
    for (std::size_t y = 0; y < count[1]; ++y)
      for (std::size_t x = 0; x < count[0]; ++x) {
        const Place place = places[0][x] + places[1][y] + places[2][z];
        const std::int32_t block = index_[place / kBlockCells];
        if (block >= 0) blocks_[static_cast<std::size_t>(block)].flags[place % kBlockCells] |= kBesideSurface;
      }
}

/// Finds the crossings of a ray along the axis; after the last one there is one that comes never.
/// @return how many there are.
int ScanGrid::Axis::cross(double from, double to, Crossing* crossing) const {
  int at = static_cast<int>(from);  // floor: keys are not negative
  const int steps = static_cast<int>(to) - at;
  const int step = steps < 0 ? -1 : 1;
  const double delta = 1 / std::abs(to - from);  // share of the ray from border to border
  double share = std::abs(at + (step > 0 ? 1 : 0) - from) * delta;
  for (int left = std::abs(steps); left > 0; --left, at += step, share += delta)
    *crossing++ = {std::bit_cast<std::int64_t>(share), place(at)};
  *crossing = {kNever, place(at)};
  return std::abs(steps);
}

/// @param which  of two rays that are under way at a time.
ScanGrid::RayWalk ScanGrid::walk(std::size_t which, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  int steps = 0;
  for (unsigned i = 0; i < 3; ++i) steps += axes_[i].cross(from[i], to[i], axes_[i].crossings[which].data());
  const auto first = [&](std::size_t axis) { return axes_[axis].crossings[which].data(); };
  return {steps, first(0), first(1), first(2)};
}

void ScanGrid::cast_rays(const Eigen::Vector3d& from, std::span<const Eigen::Vector3d> ends, ScanFlag flag) {
  // Each step of a ray waits for the one before it: two rays at a time.
  for (std::size_t i = 0; i < ends.size(); i += 2) {
    RayWalk one = walk(0, from, ends[i]);
    RayWalk other = i + 1 < ends.size() ? walk(1, from, ends[i + 1]) : RayWalk{};
    for (int both = std::min(one.steps, other.steps); both > 0; --both) {
      flags_at(one.place()) |= flag;
      flags_at(other.place()) |= flag;
      one.step();
      other.step();
    }
    for (RayWalk rest = one.steps > 0 ? one : other; rest.steps > 0; rest.step())
      flags_at(rest.place()) |= flag;
  }
}

}  // namespace rds::mapper
