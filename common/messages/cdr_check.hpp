// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "common/messages/fields.hpp"

namespace rds::messages {

/// Whether the bytes are one whole message of this layout: encapsulation header CDR_BE or CDR_LE, every
/// length within the bytes that are left, strings terminated and within their bound, booleans 0 or 1, at most
/// three bytes of padding at the end. Allocates nothing, so it stands before every decoder: what passes costs
/// the decoder memory in proportion to the bytes, whoever sent them.
bool is_well_formed(std::span<const std::uint8_t> bytes, const StructLayout& layout);

/// Sets the alignment bytes between the members of a whole message to zero: Fast CDR skips them, and what
/// stood in that memory before would go out on the network.
void clear_padding(std::span<std::uint8_t> bytes, const StructLayout& layout);

}  // namespace rds::messages
