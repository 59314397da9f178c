// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace rds::service {

/// One of several services of a kind in a domain.
struct Candidate {
  std::uint64_t instance = 0;
  bool active = false;
  double active_s = 0;  // [s] since it became active
};

/// Whether a service is to be active beside the others of its kind, or to wait as stand-by.
///
/// Of two that are active the one that has been for longer stays; within a second, which the way of a status
/// may take, the lower instance. Who waits becomes active when nobody is. Ages are compared instead of times,
/// so that clocks need not agree.
inline bool shall_be_active(const Candidate& self, std::span<const Candidate> others) {
  constexpr double kSameAgeS = 1.0;
  for (const Candidate& other : others) {
    if (!other.active) continue;
    if (!self.active) return false;
    const double older_by_s = other.active_s - self.active_s;
    if (older_by_s > kSameAgeS) return false;
    if (older_by_s > -kSameAgeS && other.instance < self.instance) return false;
  }
  return true;
}

}  // namespace rds::service
