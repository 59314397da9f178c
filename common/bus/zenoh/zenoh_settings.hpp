// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "common/bus/participant.hpp"
#include "common/bus/zenoh/zenoh_access.hpp"

namespace rds::bus::detail {

/// Bytes from which a message goes through shared memory, where there is any: less is faster through a link.
inline constexpr std::size_t kLeastShared = 64 << 10;
/// Bytes of the largest message that is taken.
inline constexpr std::size_t kLargestMessage = 256 << 20;

// A session's configuration in Zenoh's own form; common/bus/zenoh/README.md explains it.

/// @param access  of a secured domain: every link is encrypted, and of those who have a certificate. @throws
/// BusError
///                if a peer is named by another kind of link.
std::string zenoh_settings(const ParticipantOptions& options, const ZenohAccess* access = nullptr);

/// Where a session looks for a router though nobody has named one, neither by `--peers` nor in the user's
/// file; "" if it does not.
std::string unnamed_endpoint(const ParticipantOptions& options, const ZenohAccess* access);

/// Of a router, for all domains. Endpoints, names or addresses; @throws BusError as above.
std::string zenoh_router_settings(const std::vector<std::string>& listen,
                                  const std::vector<std::string>& connect,
                                  const ZenohAccess* access = nullptr);

}  // namespace rds::bus::detail
