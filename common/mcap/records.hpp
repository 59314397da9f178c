// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

/// The records of an MCAP file (https://mcap.dev/spec). All numbers are little-endian.
namespace rds::mcap {

using Bytes = std::vector<std::uint8_t>;
using View = std::span<const std::uint8_t>;

inline constexpr std::array<std::uint8_t, 8> kMagic{0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};
/// Before each record's content: what it is (one byte) and the content's length (eight).
inline constexpr std::uint64_t kPrefixBytes = 9;

enum class Opcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0B,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
};

struct Header {
  std::string profile = {};
  std::string library = {};
};

/// A message type.
struct Schema {
  std::uint16_t id = 0;       // 0 is no schema's
  std::string name = {};      // "sensor_msgs/msg/Image"
  std::string encoding = {};  // of data: "ros2msg"
  std::string data = {};      // its definition
};

struct Channel {
  std::uint16_t id = 0;
  std::uint16_t schema_id = 0;
  std::string topic = {};
  std::string message_encoding = {};  // "cdr"
  std::map<std::string, std::string> metadata = {};
};

/// Times in ns since 1970.
struct Message {
  std::uint16_t channel_id = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_time = 0;
  std::uint64_t publish_time = 0;
  View data = {};
};

struct Chunk {
  std::uint64_t start_time = 0;
  std::uint64_t end_time = 0;
  std::uint64_t uncompressed_size = 0;
  std::uint32_t uncompressed_crc = 0;  // 0: not computed
  std::string compression = {};        // "", "lz4", "zstd"
  View records = {};
};

/// Where a channel's messages lie in the chunk before it: (log time, offset in the uncompressed records).
using MessageIndex = std::vector<std::pair<std::uint64_t, std::uint64_t>>;

struct ChunkIndex {
  std::uint64_t start_time = 0;
  std::uint64_t end_time = 0;
  std::uint64_t chunk_offset = 0;  // in the file
  std::uint64_t chunk_length = 0;  // with its prefix
  std::map<std::uint16_t, std::uint64_t> message_index_offsets = {};
  std::uint64_t message_index_length = 0;  // of all of them
  std::string compression = {};
  std::uint64_t compressed_size = 0;
  std::uint64_t uncompressed_size = 0;
};

}  // namespace rds::mcap
