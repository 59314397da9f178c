// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/mapper/core/evidence/keyframe_view.hpp"
#include "services/mapper/core/evidence/sightings.hpp"

// What a map says of a voxel, as a function of all that keyframes say of it: a sum over the keyframes in the
// order of their times, so that it does not matter in which order they came.
//
// Paper §IV-C, Eq. (2), with log-odds clamped to P in [.12, .97]:
//
//   L ← clamp(L + l(observation))        l = +.85 for a static surface, −.41 for a ray that passes, or a
//                                        surface of something dynamic
//
// Misses since the voxel was hit last are noise (a surface at a grazing angle, an edge), or what stood there
// has gone. C is L with these misses taken for a change, by what was known of the voxel; who sees it again
// says that it was noise. A voxel is occupied if C > 0:
//
//   seen     C ← L                       as static or doubtful, a hit or not; L with the hit
//   miss     C ← clamp(C − m)            m = 1.2 if C > 0 and b < 0   (ghost)
//                                        m = 1.2 if C > 0 and remembered: not seen since it was saved
//                                        m = .7  if C > 0 and r ≥ 8   (solid)
//                                        m = .41 else: as the paper
//
//   b   keyframes that saw it as static or doubtful, less those that saw something dynamic there; in ±100
//   r   hits in a row before the last miss
//
//   observation     is
//   static          a hit; nothing on a transient surface
//   doubtful        a hit on a confirmed surface, else nothing
//   unknown         as doubtful
//   passed          a miss
//   no return       a miss where L > 0, or C > 0, and b ≤ 2 (what more keyframes have seen is measurable)
//
// So what has stood for long and is carried away is gone after five misses, and nine if it was often missed
// while it stood; who was taken for static now and then is gone after three; what is put somewhere is there
// after three hits. What a saved map remembers may have been moved before this visit, so three misses tell,
// too, until it is seen again: then it stands today. From the upper clamp, 3.476: 5 · .7 and 9 · .41 and 3
// · 1.2 are more. From the lower one, −1.992: 3 · .85 is more.
//
// Which surfaces count is decided by all keyframes together. A surface is a connected one of a keyframe's
// picture, and judged as a whole, so that the end of a table that no other keyframe has seen stands or falls
// with the rest of it: it is confirmed if enough of it was seen as static at another time (a second earlier
// or later: by then something dynamic would have moved), transient if most of it is and bears no label:
//
//   transient   |S| < |D|, and τ(S) within (min τ(D) − 1 s, max τ(D) + 1 s)
//   S, D        keyframes that saw the voxel as static or doubtful, and something dynamic there; τ: times
//
// L is counted in thousandths, so that sums are exact.

namespace rds::mapper {

/// Log-odds × 1000.
using LogOdds = std::int16_t;
inline constexpr LogOdds kLowest = -1992;  // P = .12
inline constexpr LogOdds kHighest = 3476;  // P = .97
inline constexpr double kPerNat = 1000;
inline float in_nats(LogOdds log_odds) {
  return static_cast<float>(log_odds / kPerNat);
}

/// Hits in a row, no more are counted. Of voxels that are missed in a third of the keyframes while they
/// stand, one in 25 comes so far.
inline constexpr std::int8_t kSolidRow = 8;
/// Limit of the balance of static and dynamic sightings.
inline constexpr std::int8_t kMostBalance = 100;

/// The occupancy of the voxels of a block after some keyframes.
struct BlockOccupancy {
  PerCell<LogOdds> values{};       // C: what the map shows
  PerCell<LogOdds> lasting{};      // L
  PerCell<std::int8_t> row{};      // r; negative after a miss
  PerCell<std::int8_t> balance{};  // b
  BlockMask known;                 // hit or missed by a keyframe
  BlockMask remembered;            // occupied in a saved map, and not seen as static or doubtful since

  /// The next keyframe.
  void add(const BlockStep& step);
  /// Voxels of which another value, or nothing, is known.
  [[nodiscard]] BlockMask changed_since(const BlockOccupancy& before) const;
};

}  // namespace rds::mapper
