// SPDX-License-Identifier: Apache-2.0
#include "tools/recording/bag/qos_profiles.hpp"

#include <fmt/format.h>

namespace rds::recording {
namespace {

// Of rmw/types.h.
constexpr int kHistoryUnknown = 3;
constexpr int kReliable = 1;
constexpr int kBestEffort = 2;
constexpr int kTransientLocal = 1;
constexpr int kVolatile = 2;
constexpr int kLivelinessAutomatic = 1;
constexpr const char* kForEver = "\n    sec: 9223372036\n    nsec: 854775807";

}  // namespace

std::string offered_qos_profile(bool reliable, bool transient_local) {
  return fmt::format(
      "- history: {}\n  depth: 0\n  reliability: {}\n  durability: {}\n  deadline:{}\n  lifespan:{}\n  "
      "liveliness: {}\n"
      "  liveliness_lease_duration:{}\n  avoid_ros_namespace_conventions: false",
      kHistoryUnknown, reliable ? kReliable : kBestEffort, transient_local ? kTransientLocal : kVolatile,
      kForEver, kForEver, kLivelinessAutomatic, kForEver);
}

}  // namespace rds::recording
