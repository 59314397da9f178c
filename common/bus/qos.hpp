// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace rds::bus {

/// What goes first where there is not room for all, the most urgent first. Only Zenoh orders messages by it.
enum class Urgency { kState, kBoxes, kKeyframes, kMaps, kPictures };

/// What a topic promises; both ends use the same profile. `depth` 0 keeps all samples up to `max_samples`.
struct Qos {
  bool reliable = true;
  bool transient_local = false;
  int depth = 10;
  int max_samples = 5000;
  /// Whether a reader counts what never came as dropped. Not where the newest message of a writer replaces
  /// the ones before: what was replaced before it was sent is no loss.
  bool counts_lost = true;
  /// Whether a writer may take a second before it sends again what readers lack. For what is large and
  /// soon replaced: readers behind a slow link ask for the same again and again while it is on its way.
  bool repairs_slowly = false;
  /// Whether a reader that asks for reliability is content without, where that is all that is offered.
  bool follows_publishers = false;
  /// Of poses, states, commands and whatever else is small, if nothing else is said.
  Urgency urgency = Urgency::kState;
};

// The profiles of the topic table (see common/bus/README.md).
inline constexpr Qos kSensor{
    .reliable = true, .depth = 5, .follows_publishers = true, .urgency = Urgency::kPictures};
inline constexpr Qos kSensorBestEffort{.reliable = false, .depth = 5, .urgency = Urgency::kPictures};
/// The same for a player that waits for each picture's pose: none may be missing, so on Zenoh, too, what is
/// lost is asked for again, as keyframes are.
inline constexpr Qos kSensorLockstep{
    .reliable = true, .depth = 5, .follows_publishers = true, .urgency = Urgency::kKeyframes};
inline constexpr Qos kStream{.reliable = true, .depth = 10};
inline constexpr Qos kTransform{.reliable = true, .depth = 100};
inline constexpr Qos kPoses{.reliable = true, .transient_local = true, .depth = 100};
inline constexpr Qos kCommand{.reliable = true, .depth = 100};
inline constexpr Qos kKeyframeImages{
    .reliable = true, .transient_local = true, .depth = 20, .urgency = Urgency::kKeyframes};
inline constexpr Qos kKeyframeFeatures{
    .reliable = true, .transient_local = true, .depth = 0, .urgency = Urgency::kKeyframes};
/// The boxes of as many keyframes as are made in some minutes, so that a mapper which starts again, or was
/// out of reach, gets them: 2 MB.
inline constexpr Qos kBoxes{
    .reliable = true, .transient_local = true, .depth = 1000, .urgency = Urgency::kBoxes};
/// What the reader itself asks for again.
inline constexpr Qos kDatagrams{.reliable = false, .depth = 256, .urgency = Urgency::kKeyframes};
inline constexpr Qos kDelta{.reliable = true, .depth = 64, .repairs_slowly = true, .urgency = Urgency::kMaps};
inline constexpr Qos kLatched{.reliable = true, .transient_local = true, .depth = 1, .counts_lost = false};
inline constexpr Qos kLatchedLarge{.reliable = true,
                                   .transient_local = true,
                                   .depth = 1,
                                   .counts_lost = false,
                                   .repairs_slowly = true,
                                   .urgency = Urgency::kMaps};
/// For a reader of the newest message of each of many writers.
inline constexpr Qos kLatchedOfEach{
    .reliable = true, .transient_local = true, .depth = 100, .counts_lost = false};
/// For a reader of a latched topic that must see every message, not only the newest; so must one of a topic
/// with two writers, whose newest messages displace each other in a history of one.
inline constexpr Qos kLatchedEvery{.reliable = true, .transient_local = true, .depth = 100};

}  // namespace rds::bus
