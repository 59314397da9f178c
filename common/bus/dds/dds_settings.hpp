// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/bus/participant.hpp"

/// What both vendors of DDS are given alike.
namespace rds::bus::detail {

// The highest participant number searched on 127.0.0.1, how often a participant
// announces itself, and after which silence the others give it up. A loaded machine must not lose
// participants that live.
inline constexpr int kLoopbackParticipants = 60;
/// On the network every machine hears each announcement, also one that has no part in this.
inline int announcement_period_s(const ParticipantOptions& options) {
  return options.loopback_only ? 1 : 3;
}
inline constexpr int kLeaseDurationS = 10;

}  // namespace rds::bus::detail
