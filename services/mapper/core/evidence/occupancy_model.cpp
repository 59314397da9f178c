// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/evidence/occupancy_model.hpp"

#include <algorithm>
#include <cstring>

namespace rds::mapper {
namespace {

constexpr LogOdds kHit = 85;
constexpr LogOdds kMiss = -41;
constexpr LogOdds kGhostMiss = -120;  // a voxel at the upper clamp is free after three rays
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

/// The observations or verdicts of eight cells.
void load_bytes(Lanes& lanes, const std::uint8_t& first) {
  ByteLanes bytes;
  load(bytes, first);
  lanes = __builtin_convertvector(bytes, Lanes);
}

void note_known(std::uint8_t& first, const Lanes& is_known) {
  ByteLanes known;
  load(known, first);
  known |= __builtin_convertvector(is_known, ByteLanes);
  std::memcpy(&first, &known, sizeof(known));
}

}  // namespace

void BlockCounts::add(const BlockObservations& observations, EvidenceTime time) {
  for (std::size_t i = 0; i < kBlockCells; ++i) {
    const int observed = observations[i] & kObservationBits;
    const bool is_static = observed >= code(Observation::kDoubtful);
    const bool is_dynamic = observations[i] >= kNearDynamic;
    surfaces[i] = static_cast<std::uint16_t>(surfaces[i] + (observed >= code(Observation::kUnknown) ? 1 : 0));
    statics[i] = static_cast<std::uint16_t>(statics[i] + (is_static ? 1 : 0));
    dynamics[i] = static_cast<std::uint16_t>(dynamics[i] + (is_dynamic ? 1 : 0));
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
    verdicts[i] = static_cast<std::uint8_t>((is_ghost ? kGhost : 0) | (is_seldom ? kSeldom : 0));
  }
  return verdicts;
}

void BlockLogOdds::add_plain(const BlockObservations& observations) {
  for (std::size_t i = 0; i < kBlockCells; i += kLanes) {
    Lanes observed;
    Lanes value;
    load_bytes(observed, observations[i]);
    load(value, values[i]);
    const Lanes is_hit = observed == code(Observation::kStatic);
    const Lanes is_miss = observed == code(Observation::kPassed);
    value += (is_hit & kHit) + (is_miss & kMiss);
    value = value < kLowest ? kLowest - Lanes{} : value;
    value = value > kHighest ? kHighest - Lanes{} : value;
    std::memcpy(&values[i], &value, sizeof(value));
    note_known(known[i], is_hit | is_miss);
  }
}

void BlockLogOdds::add(const BlockObservations& observations, EvidenceTime time,
                       const PerCell<EvidenceTime>& last_static, const BlockVerdicts& verdicts) {
  for (std::size_t i = 0; i < kBlockCells; i += kLanes) {
    Lanes observed;
    Lanes verdict;
    Lanes value;
    TimeLanes last;
    load_bytes(observed, observations[i]);
    load_bytes(verdict, verdicts[i]);
    load(value, values[i]);
    load(last, last_static[i]);
    observed &= kObservationBits;
    const Lanes is_hit = observed == code(Observation::kStatic);
    const Lanes is_passed = observed == code(Observation::kPassed);
    const Lanes is_occupied = value > 0;
    const Lanes is_later = __builtin_convertvector(last <= time, Lanes);
    const Lanes is_left = is_occupied & is_later & ((verdict & kGhost) != 0);
    const Lanes is_carved = is_occupied & (observed == code(Observation::kNoReturn)) &
                            (is_left | ((verdict & kSeldom) != 0));
    const Lanes miss = (is_left & kGhostMiss) | (~is_left & kMiss);
    value += (is_hit & kHit) + ((is_passed | is_carved) & miss);
    value = value < kLowest ? kLowest - Lanes{} : value;
    value = value > kHighest ? kHighest - Lanes{} : value;
    std::memcpy(&values[i], &value, sizeof(value));
    note_known(known[i], is_hit | is_passed);
  }
}

}  // namespace rds::mapper
