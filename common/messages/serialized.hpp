// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "common/bus/type_ops.hpp"

namespace rds::messages {

/// A message as it is on the wire: encapsulation header and CDR.
struct SerializedMessage {
  std::vector<std::uint8_t> bytes;
};

/// A type whose messages a participant carries as SerializedMessage, neither decoded nor checked; names and
/// hash stay. It has to outlive the participant, which carries a type either so or decoded.
bus::TypeOps serialized(const bus::TypeOps& type);

}  // namespace rds::messages
