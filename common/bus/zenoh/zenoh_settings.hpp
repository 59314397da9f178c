// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/bus/participant.hpp"

namespace rds::bus::detail {

/// A session's configuration in Zenoh's own form; common/bus/zenoh/README.md explains it.
std::string zenoh_settings(const ParticipantOptions& options);

}  // namespace rds::bus::detail
