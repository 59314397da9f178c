// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "common/transfer/transfer.hpp"

namespace rds::transfer {

/// Where items go for which there is no room in memory.
class ItemSpill {
 public:
  using Bytes = std::vector<std::uint8_t>;

  ItemSpill() = default;
  ItemSpill(const ItemSpill&) = delete;
  ItemSpill& operator=(const ItemSpill&) = delete;
  virtual ~ItemSpill() = default;
  /// @return false if it could not be kept.
  virtual bool put(Stream stream, std::uint64_t number, const Bytes& item) = 0;
  /// nullopt: it is not there, or not as it was.
  virtual std::optional<Bytes> get(Stream stream, std::uint64_t number) = 0;
  virtual void erase(Stream stream, std::uint64_t number) = 0;
  virtual void clear() = 0;
};

/// The items that a writer keeps for its readers, within bounds: the newest in memory, older ones in the
/// spill. What cannot be kept is counted as lost.
class ItemStore {
 public:
  using Bytes = ItemSpill::Bytes;

  /// @param memory_bytes  of items; beyond, the oldest of the stream that has most go into the spill.
  /// @param spill_bytes   of those; beyond, the oldest are forgotten in the same way.
  explicit ItemStore(std::size_t memory_bytes, std::unique_ptr<ItemSpill> spill = nullptr,
                     std::size_t spill_bytes = 0)
      : memory_(memory_bytes), spilled_(spill_bytes), spill_(std::move(spill)) {}

  /// One that is empty or larger than kMaxItemBytes is lost.
  void put(Stream stream, std::uint64_t number, Bytes item);
  /// nullptr: it is not there. Valid until the next call.
  [[nodiscard]] const Bytes* find(Stream stream, std::uint64_t number);
  /// Whether there was one of this number, and is no more.
  [[nodiscard]] bool is_lost(Stream stream, std::uint64_t number) const;
  /// How many these are.
  [[nodiscard]] std::uint64_t lost(Stream stream) const;
  /// Of streams that have an item.
  [[nodiscard]] std::map<Stream, Offer> offers() const;
  void clear();

 private:
  using Id = std::pair<Stream, std::uint64_t>;
  /// Items of one place, and what they take there.
  template <class Item>
  struct Shelf {
    explicit Shelf(std::size_t limit) : limit_bytes(limit) {}
    /// Oldest item of the stream that takes most; nullopt if all fit, or one alone is left.
    [[nodiscard]] std::optional<Id> too_much() const;
    /// Makes the offers reach over what is here.
    void widen(std::map<Stream, Offer>& offers) const;

    std::size_t limit_bytes;
    std::size_t bytes = 0;
    std::map<Id, Item> items;
  };

  /// Items of a stream that were there and are no more.
  struct Lost {
    std::uint64_t older = 0;          // than all that are there
    std::set<std::uint64_t> numbers;  // of the others
  };

  [[nodiscard]] std::optional<std::uint64_t> oldest(Stream stream) const;
  void lose(const Id& id);
  void spill(const Id& id);
  void forget_spilled(const Id& id);

  Shelf<Bytes> memory_;
  Shelf<std::size_t> spilled_;  // sizes
  std::map<Stream, Lost> lost_;
  std::unique_ptr<ItemSpill> spill_;
  std::deque<std::pair<Id, Bytes>> read_back_;  // what readers ask for now: they take many chunks of an item
};

}  // namespace rds::transfer
