// SPDX-License-Identifier: Apache-2.0
#include "common/mcap/decoding.hpp"

#include "common/map_file/byte_reader.hpp"

namespace rds::mcap {
namespace {

using map_file::ByteReader;

std::string get_text(ByteReader& in) {
  const auto characters = in.get_bytes(in.get<std::uint32_t>());
  return {characters.begin(), characters.end()};
}

/// @return the value, or what is wrong with the content as far as it was read.
template <class T>
Expected<T> checked(ByteReader& in, T value) {
  if (in.ok()) return value;
  return tl::unexpected(in.finish().error());
}

}  // namespace

Prefix decode_prefix(View bytes) {
  ByteReader in(bytes);
  Prefix prefix;
  prefix.opcode = static_cast<Opcode>(in.get<std::uint8_t>());
  prefix.length = in.get<std::uint64_t>();
  return prefix;
}

Expected<Schema> decode_schema(View content) {
  ByteReader in(content);
  Schema schema;
  schema.id = in.get<std::uint16_t>();
  for (auto* text : {&schema.name, &schema.encoding, &schema.data}) *text = get_text(in);
  if (schema.id == 0) in.refuse("a schema with the id 0");
  return checked(in, std::move(schema));
}

Expected<Channel> decode_channel(View content) {
  ByteReader in(content);
  Channel channel;
  channel.id = in.get<std::uint16_t>();
  channel.schema_id = in.get<std::uint16_t>();
  channel.topic = get_text(in);
  channel.message_encoding = get_text(in);
  ByteReader metadata(in.get_bytes(in.get<std::uint32_t>()));
  while (metadata.ok() && !metadata.at_end()) {
    std::string key = get_text(metadata);
    channel.metadata[std::move(key)] = get_text(metadata);
  }
  if (!metadata.ok()) in.refuse("metadata of a channel: " + metadata.finish().error());
  return checked(in, std::move(channel));
}

Expected<Message> decode_message(View content) {
  constexpr std::size_t kHeadBytes = 22;
  ByteReader in(content);
  Message message;
  message.channel_id = in.get<std::uint16_t>();
  message.sequence = in.get<std::uint32_t>();
  message.log_time = in.get<std::uint64_t>();
  message.publish_time = in.get<std::uint64_t>();
  if (in.ok()) message.data = content.subspan(kHeadBytes);
  return checked(in, message);
}

Expected<Chunk> decode_chunk(View content) {
  ByteReader in(content);
  Chunk chunk;
  chunk.start_time = in.get<std::uint64_t>();
  chunk.end_time = in.get<std::uint64_t>();
  chunk.uncompressed_size = in.get<std::uint64_t>();
  chunk.uncompressed_crc = in.get<std::uint32_t>();
  chunk.compression = get_text(in);
  chunk.records = in.get_bytes(in.get_count(1));
  return checked(in, std::move(chunk));
}

}  // namespace rds::mcap
