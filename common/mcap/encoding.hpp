// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/mcap/records.hpp"

/// Whole records, appended to bytes.
namespace rds::mcap {

void append(Bytes& out, const Header& header);
void append(Bytes& out, const Schema& schema);
void append(Bytes& out, const Channel& channel);
void append(Bytes& out, const Message& message);
void append(Bytes& out, const Chunk& chunk);
void append(Bytes& out, std::uint16_t channel_id, const MessageIndex& index);
void append(Bytes& out, const ChunkIndex& index);

/// A record whose content is encoded already.
void append(Bytes& out, Opcode opcode, View content);

}  // namespace rds::mcap
