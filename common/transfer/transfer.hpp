// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

/// Large data to readers on other machines. A reader asks for pieces of what is offered, each small enough
/// for one datagram, as fast as its link takes them; a writer only answers. So each reader has its own pace,
/// what it has missed it asks for, and a lost piece costs that piece.
namespace rds::transfer {

/// Since any fixed moment, as of a clock that never steps.
using Time = std::chrono::nanoseconds;

/// Bytes of an item in one chunk: with the headers of RTPS, its security and IP below 1400.
inline constexpr std::size_t kChunkBytes = 1200;
/// Larger items are refused: what claims to be larger is an error.
inline constexpr std::size_t kMaxItemBytes = std::size_t{256} << 20U;

/// What carries the chunks: datagrams, which may overtake each other, or a stream, in which what is late
/// holds up all that follows, and small messages overtake by their class.
enum class Way : std::uint8_t { kDatagrams, kStream };

/// Kinds of items, as on the wire.
enum class Stream : std::uint8_t { kKeyframeImages, kKeyframeFeatures, kMapUpdates };

/// The numbers that a writer can send of a stream, where they count up. One between them may be absent: its
/// chunk then says so.
struct Offer {
  std::uint64_t oldest = 0;
  std::uint64_t newest = 0;
  std::uint64_t lost = 0;  // older items that were there and cannot be had any more

  bool operator==(const Offer&) const = default;
};

/// In place of the bytes of an item that the writer does not have: there never was one of this number; there
/// was one, and nobody has it any more.
inline constexpr std::uint32_t kAbsent = 0;
inline constexpr std::uint32_t kLost = std::numeric_limits<std::uint32_t>::max();

/// Asks for chunks first … first + count - 1 of an item; those beyond its end are not answered.
struct Request {
  std::uint64_t number = 0;
  std::uint32_t first = 0;
  std::uint32_t count = 0;
};

struct Chunk {
  std::uint64_t number = 0;      // of the item
  std::uint32_t item_bytes = 0;  // of the whole item; or kAbsent, kLost
  std::uint32_t index = 0;
  std::span<const std::uint8_t> data;  // kChunkBytes, fewer in the last one
};

inline std::uint32_t chunks_in(std::size_t item_bytes) {
  return static_cast<std::uint32_t>((item_bytes + kChunkBytes - 1) / kChunkBytes);
}

/// Chunk `index` of an item. @param index  below chunks_in(item.size())
inline Chunk chunk_of(std::uint64_t number, std::span<const std::uint8_t> item, std::uint32_t index) {
  const std::size_t begin = index * kChunkBytes;
  const std::size_t size = std::min(kChunkBytes, item.size() - begin);
  return {number, static_cast<std::uint32_t>(item.size()), index, item.subspan(begin, size)};
}

}  // namespace rds::transfer
