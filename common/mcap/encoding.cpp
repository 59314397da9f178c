// SPDX-License-Identifier: Apache-2.0
#include "common/mcap/encoding.hpp"

#include <string_view>

#include "common/map_file/byte_writer.hpp"

namespace rds::mcap {
namespace {

using map_file::ByteWriter;

View view_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

void put_text(ByteWriter& out, std::string_view text) {
  out.put(static_cast<std::uint32_t>(text.size()));
  out.put_bytes(view_of(text));
}

/// Bytes whose length stands before them.
void put_block(ByteWriter& out, const ByteWriter& block) {
  out.put(static_cast<std::uint32_t>(block.bytes().size()));
  out.put_bytes(block.bytes());
}

void append_parts(Bytes& out, Opcode opcode, View first, View second) {
  ByteWriter prefix;
  prefix.put(static_cast<std::uint8_t>(opcode));
  prefix.put(static_cast<std::uint64_t>(first.size() + second.size()));
  out.insert(out.end(), prefix.bytes().begin(), prefix.bytes().end());
  out.insert(out.end(), first.begin(), first.end());
  out.insert(out.end(), second.begin(), second.end());
}

}  // namespace

void append(Bytes& out, Opcode opcode, View content) {
  append_parts(out, opcode, content, {});
}

void append(Bytes& out, const Header& header) {
  ByteWriter content;
  put_text(content, header.profile);
  put_text(content, header.library);
  append(out, Opcode::kHeader, content.bytes());
}

void append(Bytes& out, const Schema& schema) {
  ByteWriter content;
  content.put(schema.id);
  for (const auto* text : {&schema.name, &schema.encoding, &schema.data}) put_text(content, *text);
  append(out, Opcode::kSchema, content.bytes());
}

void append(Bytes& out, const Channel& channel) {
  ByteWriter content;
  content.put(channel.id);
  content.put(channel.schema_id);
  put_text(content, channel.topic);
  put_text(content, channel.message_encoding);
  ByteWriter metadata;
  for (const auto& [key, value] : channel.metadata) {
    put_text(metadata, key);
    put_text(metadata, value);
  }
  put_block(content, metadata);
  append(out, Opcode::kChannel, content.bytes());
}

void append(Bytes& out, const Message& message) {
  ByteWriter head;
  head.put(message.channel_id);
  head.put(message.sequence);
  head.put(message.log_time);
  head.put(message.publish_time);
  append_parts(out, Opcode::kMessage, head.bytes(), message.data);
}

void append(Bytes& out, const Chunk& chunk) {
  ByteWriter head;
  head.put(chunk.start_time);
  head.put(chunk.end_time);
  head.put(chunk.uncompressed_size);
  head.put(chunk.uncompressed_crc);
  put_text(head, chunk.compression);
  head.put(static_cast<std::uint64_t>(chunk.records.size()));
  append_parts(out, Opcode::kChunk, head.bytes(), chunk.records);
}

void append(Bytes& out, std::uint16_t channel_id, const MessageIndex& index) {
  ByteWriter entries;
  for (const auto& [log_time, offset] : index) {
    entries.put(log_time);
    entries.put(offset);
  }
  ByteWriter content;
  content.put(channel_id);
  put_block(content, entries);
  append(out, Opcode::kMessageIndex, content.bytes());
}

void append(Bytes& out, const ChunkIndex& index) {
  ByteWriter content;
  for (const auto number : {index.start_time, index.end_time, index.chunk_offset, index.chunk_length})
    content.put(number);
  ByteWriter offsets;
  for (const auto& [channel_id, offset] : index.message_index_offsets) {
    offsets.put(channel_id);
    offsets.put(offset);
  }
  put_block(content, offsets);
  content.put(index.message_index_length);
  put_text(content, index.compression);
  content.put(index.compressed_size);
  content.put(index.uncompressed_size);
  append(out, Opcode::kChunkIndex, content.bytes());
}

}  // namespace rds::mcap
