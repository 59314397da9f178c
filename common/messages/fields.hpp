// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace rds::messages {

enum class FieldKind : std::uint8_t { kPrimitive, kBoolean, kString, kStruct };

struct StructLayout;

/// How a member stands on the wire (XCDR1).
struct FieldLayout {
  FieldKind kind;
  std::uint32_t size;          // bytes of a primitive; fewest bytes of a string or struct
  std::uint32_t array_length;  // of a fixed-size array; most elements of a sequence, 0: any number
  bool is_sequence;
  std::uint32_t string_bound;  // 0: unbounded
  const StructLayout* nested;  // of a struct
};

struct StructLayout {
  const FieldLayout* fields;
  std::size_t field_count;
};

/// What a message type consists of; specialised for every IDL type in the generated
/// <package>/message_fields.hpp: kDdsName, kRosName, kTypeHash, kLayout, and visit(message, visitor), which
/// calls visitor("name", member) for each member in wire order, with references to the members if the message
/// is not const.
template <class T>
struct Fields;

}  // namespace rds::messages
