// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/evidence/occupancy_model.hpp"

#include <algorithm>
#include <cstring>

namespace rds::mapper {
namespace {

constexpr LogOdds kHit = 850;
constexpr LogOdds kMiss = -410;
constexpr LogOdds kGhostMiss = -1200;         // a voxel at the upper clamp is free after three rays
constexpr std::uint16_t kSeldomSurfaces = 2;  // no more may be an accident

constexpr auto code(Observation observation) {
  return static_cast<std::uint8_t>(observation);
}

// Eight cells at once; a comparison gives −1 where it holds and 0 elsewhere.
constexpr std::size_t kLanes = 8;
using Lanes = std::int16_t __attribute__((vector_size(16)));
using ByteLanes = std::uint8_t __attribute__((vector_size(8)));
using TimeLanes = EvidenceTime __attribute__((vector_size(32)));

template <class Vector, class Value>
void load(Vector& lanes, const Value& first) {
  std::memcpy(&lanes, &first, sizeof(lanes));
}

/// The observations or verdict bits of eight cells.
void load_bytes(Lanes& lanes, const std::uint8_t& first) {
  ByteLanes bytes;
  load(bytes, first);
  lanes = __builtin_convertvector(bytes, Lanes);
}

/// Adds a step to eight cells from `first` on, and notes which are known now.
void add_to(BlockLogOdds& block, std::size_t first, const Lanes& step, const Lanes& is_known) {
  Lanes value;
  load(value, block.values[first]);
  value += step;
  value = value < kLowest ? kLowest - Lanes{} : value;
  value = value > kHighest ? kHighest - Lanes{} : value;
  std::memcpy(&block.values[first], &value, sizeof(value));
  ByteLanes known;
  load(known, block.known[first]);
  known |= __builtin_convertvector(is_known, ByteLanes);
  std::memcpy(&block.known[first], &known, sizeof(known));
}

/// Counts that do not wrap: a robot that stands for hours sees a voxel in more keyframes than fit.
void count_if(bool is_seen, std::uint16_t& count) {
  count = static_cast<std::uint16_t>(count + ((count < UINT16_MAX) & is_seen ? 1 : 0));
}

}  // namespace

void BlockCounts::add(const BlockObservations& observations, EvidenceTime time) {
  for (std::size_t i = 0; i < kBlockCells; ++i) {
    const int observed = observations[i] & kObservationBits;
    const bool is_static = observed >= code(Observation::kDoubtful);
    const bool is_dynamic = observations[i] >= kNearDynamic;
    count_if(observed >= code(Observation::kUnknown), surfaces[i]);
    count_if(is_static, statics[i]);
    count_if(is_dynamic, dynamics[i]);
    first_static[i] = std::min(first_static[i], is_static ? time : kAfterAll);
    last_static[i] = std::max(last_static[i], is_static ? time : kBeforeAll);
    first_dynamic[i] = std::min(first_dynamic[i], is_dynamic ? time : kAfterAll);
    last_dynamic[i] = std::max(last_dynamic[i], is_dynamic ? time : kBeforeAll);
  }
}

bool seen_apart(const BlockCounts& counts, std::size_t cell, EvidenceTime time, EvidenceTime apart) {
  return counts.first_static[cell] <= time - apart || counts.last_static[cell] >= time + apart;
}

bool is_transient(const BlockCounts& counts, std::size_t cell, EvidenceTime apart) {
  return counts.statics[cell] < counts.dynamics[cell] &&
         counts.first_static[cell] > counts.first_dynamic[cell] - apart &&
         counts.last_static[cell] < counts.last_dynamic[cell] + apart;
}

BlockVerdicts decide(const BlockCounts& counts) {
  BlockVerdicts verdicts;
  for (std::size_t i = 0; i < kBlockCells; ++i) {
    const bool is_surface = counts.surfaces[i] > 0;
    const bool is_ghost = is_surface & (counts.statics[i] < counts.dynamics[i]);
    const bool is_seldom = is_surface & (counts.surfaces[i] <= kSeldomSurfaces);
    verdicts.bits[i] = static_cast<std::uint8_t>((is_ghost ? kGhost : 0) | (is_seldom ? kSeldom : 0));
    verdicts.ghost_static_last[i] = is_ghost ? counts.last_static[i] : kBeforeAll;
  }
  return verdicts;
}

void BlockLogOdds::add_plain(const BlockObservations& observations) {
  for (std::size_t i = 0; i < kBlockCells; i += kLanes) {
    Lanes observed;
    load_bytes(observed, observations[i]);
    const Lanes is_hit = observed == code(Observation::kStatic);
    const Lanes is_miss = observed == code(Observation::kPassed);
    add_to(*this, i, (is_hit & kHit) + (is_miss & kMiss), is_hit | is_miss);
  }
}

void BlockLogOdds::add(const BlockObservations& observations, EvidenceTime time,
                       const BlockVerdicts& verdicts) {
  for (std::size_t i = 0; i < kBlockCells; i += kLanes) {
    Lanes observed;
    Lanes verdict;
    Lanes value;
    TimeLanes static_last;
    load_bytes(observed, observations[i]);
    load_bytes(verdict, verdicts.bits[i]);
    load(value, values[i]);
    load(static_last, verdicts.ghost_static_last[i]);
    observed &= kObservationBits;
    const Lanes is_hit = observed == code(Observation::kStatic);
    const Lanes is_passed = observed == code(Observation::kPassed);
    const Lanes is_occupied = value > 0;
    const Lanes is_later = __builtin_convertvector(static_last <= time, Lanes);
    const Lanes is_left = is_occupied & is_later & ((verdict & kGhost) != 0);
    const Lanes is_carved =
        is_occupied & (observed == code(Observation::kNoReturn)) & (is_left | ((verdict & kSeldom) != 0));
    const Lanes miss = (is_left & kGhostMiss) | (~is_left & kMiss);
    add_to(*this, i, (is_hit & kHit) + ((is_passed | is_carved) & miss), is_hit | is_passed);
  }
}

}  // namespace rds::mapper
