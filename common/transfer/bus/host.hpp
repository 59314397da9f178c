// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace rds::transfer {

/// Names this machine and the network that this process sees, never 0: who has the same one reaches this
/// process without a cable. Containers with a network of their own count as other machines.
std::uint64_t this_host();

}  // namespace rds::transfer
