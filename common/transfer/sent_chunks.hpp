// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "common/transfer/transfer.hpp"

namespace rds::transfer {

/// Which chunks of the items that were sent last went to which reader: what goes again is what a link's
/// losses cost.
class SentChunks {
 public:
  static constexpr std::size_t kItems = 64;  // a reader has 8 begun

  /// Takes note that a chunk is sent. @return true if it was sent to this reader before; never of one that
  /// says that there is no such item
  bool note(std::uint64_t reader, Stream stream, const Chunk& chunk) {
    if (chunk.item_bytes == kAbsent || chunk.item_bytes == kLost) return false;
    std::vector<bool>& chunks = chunks_of({reader, stream, chunk.number});
    chunks.resize(chunks_in(chunk.item_bytes));  // what is asked for may lie anywhere
    if (chunk.index >= chunks.size()) return false;
    const bool before = chunks[chunk.index];
    chunks[chunk.index] = true;
    return before;
  }

 private:
  struct ItemId {
    std::uint64_t reader;
    Stream stream;
    std::uint64_t number;
    bool operator==(const ItemId&) const = default;
  };
  struct Item {
    ItemId id;
    std::vector<bool> chunks;  // those that were sent
  };

  std::vector<bool>& chunks_of(const ItemId& id) {
    for (auto item = items_.rbegin(); item != items_.rend(); ++item)
      if (item->id == id) return item->chunks;
    if (items_.size() == kItems) items_.pop_front();
    return items_.emplace_back(Item{id, {}}).chunks;
  }

  std::deque<Item> items_;  // the newest last
};

}  // namespace rds::transfer
