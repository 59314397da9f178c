// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "common/transfer/assembly.hpp"
#include "common/transfer/deadlines.hpp"
#include "common/transfer/transfer.hpp"
#include "common/transfer/wanted.hpp"
#include "common/transfer/window.hpp"

namespace rds::transfer {

struct Item {
  std::uint64_t number = 0;
  std::vector<std::uint8_t> bytes;
};

/// Which of the items that a reader lacks comes first.
enum class Order : std::uint8_t {
  kNewest,  // what is fresh counts; older ones follow
  kNumber   // each after all before it, for readers that take no other order
};

struct ReceiverStatistics {
  std::uint64_t items = 0;        // that have come
  std::uint64_t chunks = 0;       // of use
  std::uint64_t repeated = 0;     // came twice, or when nobody waited for them
  std::uint64_t asked_again = 0;  // chunks that were lost
  std::uint64_t absent = 0;       // numbers of which there never was an item
  std::uint64_t given_up = 0;     // items that cannot be had any more, those from before the first offer too
  std::uint64_t impossible = 0;   // chunks that cannot be right
};

/// Fetches the items of one writer's stream. An item that has been begun is finished first, so a slow link
/// still carries whole ones, as fresh as it can.
///
/// Has no clock and no thread: whoever owns it sends what due() returns and calls it again at next_due(), and
/// after each offer or chunk.
class Receiver {
 public:
  static constexpr std::size_t kMostBegun = 8;  // items at a time

  explicit Receiver(Order order, Way way = Way::kDatagrams) : order_(order), window_(way) {}

  void offer(const Offer& offer, Time now);
  /// @return the item, if this chunk completes it
  std::optional<Item> take(const Chunk& chunk, Time now);
  /// What to ask for now. @param may_begin  false: only for the rest of items that have been begun
  std::vector<Request> due(Time now, bool may_begin = true);
  /// When due() has something to say even if nothing comes until then.
  [[nodiscard]] std::optional<Time> next_due() const;

  /// Items that are offered and not here yet.
  [[nodiscard]] std::size_t lacking() const { return wanted_.missing().size(); }
  /// Of these, those that should be here by now (Deadlines): the link is full, or they cannot be had for now.
  [[nodiscard]] std::size_t overdue(Time now) const;
  /// When further ones would be.
  [[nodiscard]] std::optional<Time> next_overdue(Time now) const;
  [[nodiscard]] const ReceiverStatistics& statistics() const { return statistics_; }
  [[nodiscard]] const Window& window() const { return window_; }

 private:
  using ChunkId = std::pair<std::uint64_t, std::uint32_t>;  // of an item's number
  struct Asked {
    ChunkId chunk;
    Time at{};
    bool again = false;  // not for the first time
  };
  using Orders = std::map<std::uint64_t, Asked>;  // counted as they were asked for
  struct Begun {
    std::uint64_t turn = 0;  // counts up with each item that is begun
    Assembly assembly;
  };

  void arrive(const ChunkId& chunk, Time now);
  void add(const Chunk& chunk, Assembly& assembly);
  void give_up_lost(Time now);
  void lose(Orders::iterator asked);
  void finish(std::uint64_t number);
  void forget_asked(std::uint64_t number, std::uint32_t first_chunk);
  [[nodiscard]] std::optional<ChunkId> next_chunk(bool may_begin);
  [[nodiscard]] std::optional<std::uint64_t> next_item() const;
  [[nodiscard]] std::uint32_t first_chunks() const;

  Order order_;
  bool was_offered_ = false;
  std::uint32_t latest_chunks_ = 0;  // of the item that was whole last
  Wanted wanted_;
  Deadlines deadlines_;
  std::map<std::uint64_t, Begun> begun_;
  Orders in_flight_;
  std::map<ChunkId, std::uint64_t> order_of_;  // of what is in flight
  std::uint64_t next_order_ = 0;
  std::uint64_t overtaken_ = 0;  // orders below it that are in flight
  std::uint64_t turn_ = 0;
  Time last_arrival_{};
  Window window_;
  ReceiverStatistics statistics_;
};

}  // namespace rds::transfer
