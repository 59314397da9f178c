// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "services/mapper/core/evidence/observation.hpp"

// What a map says of a voxel, as a function of all that keyframes say of it.
//
// Paper §IV-C, Eq. (2), over the keyframes in the order of their ids:
//
//   L₀ = 0,  L ← clamp(L + l(observation), log-odds(.12), log-odds(.97)),  occupied if L > 0
//
// with l = +.85 for a static surface and −.41 for a ray that passes, or a surface of something dynamic. What
// is not that plain is decided by all keyframes together:
//
//   S, D     keyframes that saw the voxel as static or doubtful, and something dynamic there
//   τ(·)     their times; apart = 1 s: by then something dynamic would have moved
//   ghost       |S| < |D|
//   transient   ghost, and τ(S) within (min τ(D) − apart, max τ(D) + apart)
//   seldom      a surface in no more than two keyframes
//
//   observation     l
//   static          +.85; 0 on a transient surface
//   doubtful        +.85 on a confirmed surface, else 0
//   unknown         as doubtful
//   passed          −.41; −1.2 if L > 0 and the voxel is a ghost that was not static later
//   no return       if L > 0: −1.2 for such a ghost, −.41 if seldom; else 0
//
// A surface is a connected one of a keyframe's picture, and judged as a whole, so that the end of a table
// that no other keyframe has seen stands or falls with the rest of it: it is confirmed if enough of it was
// seen as static at another time, transient if most of it is and bears no label.
//
// L is counted in thousandths, so that sums are exact.

namespace rds::mapper {

/// Milliseconds, from a keyframe of the map on.
using EvidenceTime = std::int32_t;
inline constexpr EvidenceTime kBeforeAll = std::numeric_limits<EvidenceTime>::min() / 2;
inline constexpr EvidenceTime kAfterAll = std::numeric_limits<EvidenceTime>::max() / 2;

template <class Value>
using PerCell = std::array<Value, kBlockCells>;

/// Log-odds × 1000.
using LogOdds = std::int16_t;
inline constexpr LogOdds kLowest = -1992;  // P = .12
inline constexpr LogOdds kHighest = 3476;  // P = .97
inline constexpr double kPerNat = 1000;
inline float in_nats(LogOdds log_odds) {
  return static_cast<float>(log_odds / kPerNat);
}

/// How often and when keyframes have seen the voxels of a block as what.
struct BlockCounts {
  PerCell<std::uint16_t> surfaces{};  // static, doubtful or unknown
  PerCell<std::uint16_t> statics{};   // S
  PerCell<std::uint16_t> dynamics{};  // D
  PerCell<EvidenceTime> first_static = filled(kAfterAll);
  PerCell<EvidenceTime> last_static = filled(kBeforeAll);
  PerCell<EvidenceTime> first_dynamic = filled(kAfterAll);
  PerCell<EvidenceTime> last_dynamic = filled(kBeforeAll);

  void add(const BlockObservations& observations, EvidenceTime time);

  static PerCell<EvidenceTime> filled(EvidenceTime time) {
    PerCell<EvidenceTime> cells;
    cells.fill(time);
    return cells;
  }
};

/// Whether a voxel was seen as static so long before or after a time.
/// @param apart  by then something dynamic would have moved.
bool seen_apart(const BlockCounts& counts, std::size_t cell, EvidenceTime time, EvidenceTime apart);
bool is_transient(const BlockCounts& counts, std::size_t cell, EvidenceTime apart);

inline constexpr std::uint8_t kGhost = 1;
inline constexpr std::uint8_t kSeldom = 2;

/// What all keyframes together say of the voxels of a block.
struct BlockVerdicts {
  PerCell<std::uint8_t> bits;               // kGhost, kSeldom
  PerCell<EvidenceTime> ghost_static_last;  // when a ghost was static last; kBeforeAll for all others

  bool operator==(const BlockVerdicts&) const = default;
};
BlockVerdicts decide(const BlockCounts& counts);

/// The log-odds of the voxels of a block.
struct BlockLogOdds {
  PerCell<LogOdds> values{};
  PerCell<std::uint8_t> known{};  // 255 where a ray passed or a surface counts, else 0

  /// The next keyframe, where no verdict matters.
  /// @param observations  none doubtful or unknown, here and below.
  void add_plain(const BlockObservations& observations);
  /// The next keyframe. @param verdicts  by all keyframes.
  void add(const BlockObservations& observations, EvidenceTime time, const BlockVerdicts& verdicts);
};

}  // namespace rds::mapper
