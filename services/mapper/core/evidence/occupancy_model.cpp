// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/evidence/occupancy_model.hpp"

#include <cstring>

namespace rds::mapper {
namespace {

constexpr LogOdds kHit = 850;
constexpr LogOdds kMiss = 410;
constexpr LogOdds kSolidMiss = 700;        // a voxel at the upper clamp is free after five
constexpr LogOdds kGhostMiss = 1200;       // after three, as one that is only remembered
constexpr std::int8_t kSeldomBalance = 2;  // no more sightings may be an accident

// Eight cells at once; a comparison gives −1 where it holds and 0 elsewhere.
constexpr std::size_t kLanes = 8;
using Lanes = std::int16_t __attribute__((vector_size(16)));
using ByteLanes = std::int8_t __attribute__((vector_size(8)));

/// Of eight cells in a set, −1 for those that are in it.
constexpr auto kMembers = [] {
  std::array<std::array<std::int16_t, kLanes>, 256> members{};
  for (std::size_t set = 0; set < members.size(); ++set)
    for (std::size_t i = 0; i < kLanes; ++i)
      members[set][i] = static_cast<std::int16_t>((set >> i & 1U) != 0 ? -1 : 0);
  return members;
}();

Lanes members(const BlockMask& mask, std::size_t first) {
  Lanes lanes;
  std::memcpy(&lanes, kMembers[mask.eight(first)].data(), sizeof(lanes));
  return lanes;
}

Lanes load(const LogOdds& first) {
  Lanes lanes;
  std::memcpy(&lanes, &first, sizeof(lanes));
  return lanes;
}
Lanes load(const std::int8_t& first) {
  ByteLanes bytes;
  std::memcpy(&bytes, &first, sizeof(bytes));
  return __builtin_convertvector(bytes, Lanes);
}
void store(const Lanes& lanes, LogOdds& first) {
  std::memcpy(&first, &lanes, sizeof(lanes));
}
void store(const Lanes& lanes, std::int8_t& first) {
  const ByteLanes bytes = __builtin_convertvector(lanes, ByteLanes);
  std::memcpy(&first, &bytes, sizeof(bytes));
}

Lanes clamped(Lanes value, std::int16_t lowest, std::int16_t highest) {
  value = value < lowest ? lowest - Lanes{} : value;
  return value > highest ? highest - Lanes{} : value;
}

/// Whether a ray that passes tells nothing new of eight cells.
bool are_free_for_good(const BlockOccupancy& block, std::size_t first) {
  constexpr auto kFree = [] {
    std::array<LogOdds, kLanes> free{};
    free.fill(kLowest);
    return free;
  }();
  return std::memcmp(&block.values[first], kFree.data(), sizeof(kFree)) == 0 &&
         std::memcmp(&block.lasting[first], kFree.data(), sizeof(kFree)) == 0;
}

/// The equations, for eight cells.
void add_to(BlockOccupancy& block, std::size_t i, const BlockStep& step) {
  const Lanes hit = members(step.hit, i);
  const Lanes passed = members(step.passed, i);
  const Lanes no_return = members(step.no_return, i);
  const Lanes balance =
      clamped(load(block.balance[i]) - members(step.seen_static, i) + members(step.near_dynamic, i),
              -kMostBalance, kMostBalance);
  const Lanes row = load(block.row[i]);
  const Lanes length = row < 0 ? -row : row;
  const Lanes lasting = load(block.lasting[i]);
  const Lanes value = load(block.values[i]);
  const Lanes is_occupied = value > 0;
  const Lanes is_carved = no_return & (balance <= kSeldomBalance);
  const Lanes missed = passed | (is_carved & is_occupied);
  const Lanes missed_lasting = passed | (is_carved & (lasting > 0));
  const Lanes doubted = is_occupied & ((balance < 0) | members(block.remembered, i));
  const Lanes solid = ~doubted & is_occupied & (length >= kSolidRow);
  const Lanes miss = (doubted & kGhostMiss) | (solid & kSolidMiss) | (~(doubted | solid) & kMiss);
  const Lanes lasting_now = clamped(lasting + (hit & kHit) - (missed_lasting & kMiss), kLowest, kHighest);
  const Lanes value_now = clamped(value - (missed & miss), kLowest, kHighest);
  const Lanes longer = row > 0 ? clamped(row + 1, 0, kSolidRow) : 1 - Lanes{};
  store(balance, block.balance[i]);
  store(lasting_now, block.lasting[i]);
  const Lanes is_there = hit | members(step.seen_static, i);  // so that the misses were noise
  store((is_there & lasting_now) | (~is_there & value_now), block.values[i]);
  store((hit & longer) | (missed & ~hit & -length) | (~(hit | missed) & row), block.row[i]);
}

}  // namespace

void BlockOccupancy::add(const BlockStep& step) {
  const BlockMask but_passed = step.hit | step.no_return | step.seen_static | step.near_dynamic;
  const BlockMask told = but_passed | step.passed;
  for (std::size_t i = 0; i < kBlockCells; i += kLanes) {
    if (told.eight(i) == 0 || (but_passed.eight(i) == 0 && are_free_for_good(*this, i))) continue;
    add_to(*this, i, step);
  }
  known |= step.hit | step.passed;
  remembered &= ~(step.hit | step.seen_static);
}

BlockMask BlockOccupancy::changed_since(const BlockOccupancy& before) const {
  BlockMask changed;
  for (std::size_t i = 0; i < kBlockCells; i += kLanes) {
    if (std::memcmp(&values[i], &before.values[i], kLanes * sizeof(LogOdds)) == 0) continue;
    for (std::size_t cell = i; cell < i + kLanes; ++cell)
      if (values[cell] != before.values[cell]) changed.insert(cell);
  }
  for (std::size_t i = 0; i < BlockMask::kWords; ++i) changed.word(i) |= known.word(i) ^ before.known.word(i);
  return changed;
}

}  // namespace rds::mapper
