// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "common/bus/backend.hpp"

namespace rds::bus::detail {

/// Configures Cyclone DDS for a domain of this process: the settings that common/bus/README.md explains, then
/// those of the user's CYCLONEDDS_URI, which win. The domain is left when the last holder lets go.
///
/// @throws BusError if the configuration is refused, or if the process is already in that domain with another
///         `loopback_only`.
std::shared_ptr<void> join_cyclonedds_domain(const ParticipantOptions& options);

}  // namespace rds::bus::detail
