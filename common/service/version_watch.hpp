// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>
#include <vector>

#include "common/bus/participant.hpp"

namespace rds::service {

/// At most so many endpoints of another version are told of at once.
inline constexpr std::size_t kMismatchesTold = 16;

/// "rds/map/delta: written by 01.0f.… as RIHS01_…, here it is RIHS01_…"
std::string describe(const bus::Mismatch& mismatch);

/// Tells of peers whose messages of ours are defined otherwise. For one thread.
class VersionWatch {
 public:
  explicit VersionWatch(const bus::Participant& bus) : bus_(bus) {}

  /// Logs each endpoint once, when it is seen first. @return those who are there, at most kMismatchesTold.
  std::vector<bus::Mismatch> look();

 private:
  const bus::Participant& bus_;
  std::set<std::string> told_;  // GUIDs
};

}  // namespace rds::service
