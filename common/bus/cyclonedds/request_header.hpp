// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/bus/type_ops.hpp"

namespace rds::bus::detail {

/// What rmw_cyclonedds writes before each request and each reply, behind the encapsulation header: 16 bytes,
/// so what follows is aligned as without.
struct RequestHeader {
  std::uint64_t client = 0;  // a number that the client has chosen for itself
  std::int64_t sequence = 0;

  bool operator==(const RequestHeader&) const = default;
};

/// A message as it is on the wire: encapsulation header and CDR.
using MessageBytes = std::vector<std::uint8_t>;

/// Takes the header out of a message, so that it is one of the type alone.
/// @return nullopt, and the message as it was, if it is too short to have one, or its encapsulation unknown.
std::optional<RequestHeader> take_header(MessageBytes& bytes);

/// The message of a type with a header, little-endian. @return nothing if it cannot be encoded.
MessageBytes encode_with_header(const RequestHeader& header, const TypeOps& type, const void* message);

/// The type with messages that are MessageBytes; names and hash stay. Lives as long as the program.
const TypeOps& as_bytes(const TypeOps& type);

}  // namespace rds::bus::detail
