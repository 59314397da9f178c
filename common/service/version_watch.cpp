// SPDX-License-Identifier: Apache-2.0
#include "common/service/version_watch.hpp"

#include <spdlog/spdlog.h>

namespace rds::service {

std::string describe(const bus::Mismatch& mismatch) {
  const bus::DiscoveredEndpoint& theirs = mismatch.theirs;
  return fmt::format("{}: {} by {} as {}, here it is {}", theirs.topic, theirs.publisher ? "written" : "read",
                     theirs.guid, theirs.type_hash, mismatch.own_type_hash);
}

std::vector<bus::Mismatch> VersionWatch::look() {
  std::vector<bus::Mismatch> present = bus_.mismatches();
  if (present.size() > kMismatchesTold) present.resize(kMismatchesTold);
  std::set<std::string> guids;
  for (const bus::Mismatch& mismatch : present) {
    guids.insert(mismatch.theirs.guid);
    if (!told_.contains(mismatch.theirs.guid)) spdlog::warn("another version of {}", describe(mismatch));
  }
  told_ = std::move(guids);
  return present;
}

}  // namespace rds::service
