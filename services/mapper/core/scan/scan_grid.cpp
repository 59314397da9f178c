// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/scan/scan_grid.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace rds::mapper {
namespace {

constexpr int kSide = 1 << kBlockBits;

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

void ScanGrid::cast_rays(const Eigen::Vector3d& from, std::span<const Eigen::Vector3d> ends, ScanFlag flag) {
  for (const Eigen::Vector3d& to : ends) cast_ray(from, to, flag);
}

/// Behind each border that a ray crosses lies a voxel: along the border's axis the next one, along the others
/// where the ray is there. So no step waits for the one before it, as in a walk from voxel to voxel, and each
/// axis has its own.
void ScanGrid::cast_ray(const Eigen::Vector3d& from, const Eigen::Vector3d& to, ScanFlag flag) {
  const Eigen::Vector3d way = to - from;
  const Eigen::Vector3d step = way.cwiseAbs().cwiseInverse();  // share of the ray from border to border
  std::array<int, 3> crossings{};
  Eigen::Vector3d first;
  Eigen::Vector3d last;
  octomap::OcTreeKey key;
  for (unsigned i = 0; i < 3; ++i) {
    const int at = static_cast<int>(from[i]);  // floor: keys are not negative
    key[i] = static_cast<std::uint16_t>(at);
    crossings[i] = std::abs(static_cast<int>(to[i]) - at);
    first[i] = std::abs(at + (way[i] > 0 ? 1 : 0) - from[i]) * step[i];
    last[i] = crossings[i] > 0 ? first[i] + (crossings[i] - 1) * step[i] : -1;
  }
  Eigen::Index end = 0;
  if (last.maxCoeff(&end) < 0) return;
  --crossings[static_cast<std::size_t>(end)];  // behind that border is the ray's last voxel
  flags_of(key) |= flag;
  for (unsigned i = 0; i < 3; ++i)
    if (crossings[i] > 0)
      mark_behind_borders({i, key[i], crossings[i], from + first[i] * way, way * step[i]}, flag);
}

/// Coordinates along the other axes are summed up with a fixed point.
void ScanGrid::mark_behind_borders(const Crossings& of, ScanFlag flag) {
  const unsigned b_axis = (of.axis + 1) % 3;
  const unsigned c_axis = (of.axis + 2) % 3;
  const auto fixed = [](double x) { return static_cast<std::int64_t>(x * kOne); };
  const int direction = of.step[of.axis] < 0 ? -1 : 1;
  const Place* along =
      &axes_[of.axis].places[static_cast<std::size_t>(of.before + direction - axes_[of.axis].first)];
  const Place* b_places = axes_[b_axis].places.data();
  const Place* c_places = axes_[c_axis].places.data();
  std::int64_t b = fixed(of.at[b_axis] - axes_[b_axis].first);
  std::int64_t c = fixed(of.at[c_axis] - axes_[c_axis].first);
  const bool is_one = of.count == 1;  // its step may be longer than the grid
  const std::int64_t b_step = is_one ? 0 : fixed(of.step[b_axis]);
  const std::int64_t c_step = is_one ? 0 : fixed(of.step[c_axis]);
  const std::int32_t* index = index_.data();
  Block* blocks = blocks_.data();
  for (int left = of.count; left > 0; --left, along += direction, b += b_step, c += c_step) {
    const Place place = *along + b_places[b >> kFractionBits] + c_places[c >> kFractionBits];
    const std::int32_t block = index[place / kBlockCells];
    if (block >= 0) {
      blocks[block].flags[place % kBlockCells] |= flag;
    } else {
      flags_at(place) |= flag;
      blocks = blocks_.data();
    }
  }
}

}  // namespace rds::mapper
