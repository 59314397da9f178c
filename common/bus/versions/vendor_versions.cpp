// SPDX-License-Identifier: Apache-2.0
#include "common/bus/versions/vendor_versions.hpp"

#include "common/bus/participant.hpp"
#include "common/bus/zenoh/zenoh_library.hpp"

namespace rds::bus {
namespace {

bool has_zenoh() {
  try {
    (void)detail::zenoh_library();
    return true;
  } catch (const BusError&) {
    return false;
  }
}

}  // namespace

std::string vendor_versions() {
  const std::string dds = "Fast DDS " RDS_FASTDDS_VERSION "\nCyclone DDS " RDS_CYCLONEDDS_VERSION "\n";
  return dds + (has_zenoh() ? "Zenoh " RDS_ZENOH_CRATE_VERSION : "Zenoh: not there");
}

}  // namespace rds::bus
