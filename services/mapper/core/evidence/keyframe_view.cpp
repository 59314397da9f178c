// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/evidence/keyframe_view.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

namespace rds::mapper {
namespace {

constexpr std::size_t kWords = kBlockCells / 64;
using PlaneWords = std::array<std::uint64_t, kWords>;

constexpr std::uint64_t kLowBits = 0x0101010101010101U;
constexpr std::uint64_t kGather = 0x0102040810204080U;  // brings the low bits of eight bytes into the highest

/// Eight bytes of which byte i is bit i of the index.
constexpr auto kSpread = [] {
  std::array<std::uint64_t, 256> spread{};
  for (std::size_t bits = 0; bits < spread.size(); ++bits)
    for (std::size_t i = 0; i < 8; ++i) spread[bits] |= std::uint64_t{bits >> i & 1U} << (8 * i);
  return spread;
}();

static_assert(std::endian::native == std::endian::little);

PlaneWords plane_of(const BlockObservations& observations, unsigned bit) {
  PlaneWords plane{};
  for (std::size_t i = 0; i < kBlockCells; i += 8) {
    std::uint64_t eight = 0;
    std::memcpy(&eight, &observations[i], 8);
    const std::uint64_t bits = ((eight >> bit & kLowBits) * kGather) >> 56U;
    plane[i / 64] |= bits << (i % 64);
  }
  return plane;
}

bool is_equivocal_in(std::uint8_t cell) {
  return (cell & kNearDynamic) != 0 || observation_in(cell) == Observation::kNoReturn;
}

}  // namespace

void KeyframeView::add(const octomap::OcTreeKey& key, const BlockObservations& observations,
                       const std::vector<SurfacePart>& parts) {
  Block block{{key[0], key[1], key[2]},
              {},
              std::ranges::any_of(observations, is_equivocal_in),
              static_cast<std::uint16_t>(parts.size()),
              static_cast<std::uint32_t>(words_.size()),
              static_cast<std::uint32_t>(parts_.size())};
  parts_.insert(parts_.end(), parts.begin(), parts.end());
  for (unsigned bit = 0; bit < kBitsOfObservation; ++bit) {
    const PlaneWords plane = plane_of(observations, bit);
    const bool is_uniform = std::ranges::all_of(plane, [&](auto word) { return word == plane.front(); });
    if (is_uniform && plane.front() == 0) {
      block.planes[bit] = Plane::kZeros;
    } else if (is_uniform && ~plane.front() == 0) {
      block.planes[bit] = Plane::kOnes;
    } else {
      block.planes[bit] = Plane::kStored;
      words_.insert(words_.end(), plane.begin(), plane.end());
    }
  }
  blocks_.push_back(block);
}

void KeyframeView::unpack(std::size_t at, BlockObservations& observations) const {
  const Block& block = blocks_[at];
  observations.fill(0);
  std::size_t word = block.first_word;
  for (unsigned bit = 0; bit < kBitsOfObservation; ++bit) {
    if (block.planes[bit] == Plane::kZeros) continue;
    for (std::size_t i = 0; i < kBlockCells; i += 8) {
      const std::uint64_t bits =
          block.planes[bit] == Plane::kOnes ? 0xFFU : words_[word + i / 64] >> (i % 64) & 0xFFU;
      std::uint64_t eight = 0;
      std::memcpy(&eight, &observations[i], 8);
      eight |= kSpread[bits] << bit;
      std::memcpy(&observations[i], &eight, 8);
    }
    if (block.planes[bit] == Plane::kStored) word += kWords;
  }
}

void KeyframeView::unpack_decided(std::size_t at, BlockObservations& observations) const {
  unpack(at, observations);
  if (blocks_[at].parts == 0) return;
  const SurfacePart* part = &parts_[blocks_[at].first_part];
  for (auto& cell : observations) {
    const auto observation = observation_in(cell);
    if (observation < Observation::kUnknown) continue;
    const SurfaceVerdict verdict = verdicts_[part++->surface];
    const bool counts = verdict == SurfaceVerdict::kConfirmed ||
                        (verdict == SurfaceVerdict::kUndecided && observation == Observation::kStatic);
    const auto decided = counts ? Observation::kStatic : Observation::kNone;
    cell = static_cast<std::uint8_t>((cell & kNearDynamic) | static_cast<std::uint8_t>(decided));
  }
}

void KeyframeView::set_surfaces(std::vector<bool> is_large) {
  verdicts_.assign(is_large.size(), SurfaceVerdict::kUndecided);
  is_large_ = std::move(is_large);
}

}  // namespace rds::mapper
