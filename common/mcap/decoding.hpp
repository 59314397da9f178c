// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <tl/expected.hpp>

#include "common/mcap/records.hpp"

/// A record's content as values; nothing in it is trusted. Bytes that follow the known fields are skipped, as
/// the format demands of readers.
namespace rds::mcap {

template <class T>
using Expected = tl::expected<T, std::string>;

Expected<Schema> decode_schema(View content);
Expected<Channel> decode_channel(View content);
/// Its data lie in `content`.
Expected<Message> decode_message(View content);
/// Its records lie in `content`.
Expected<Chunk> decode_chunk(View content);

/// The beginning of a record.
struct Prefix {
  Opcode opcode{};
  std::uint64_t length = 0;  // of the content
};
/// @param bytes  at least kPrefixBytes.
Prefix decode_prefix(View bytes);

}  // namespace rds::mcap
