// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "common/transfer/assembly.hpp"
#include "common/transfer/transfer.hpp"
#include "common/transfer/wanted.hpp"
#include "common/transfer/window.hpp"

namespace rds::transfer {

struct Item {
  ItemId id;
  std::vector<std::uint8_t> bytes;
};

struct ReceiverStatistics {
  std::uint64_t items = 0;        // whole ones
  std::uint64_t chunks = 0;       // of use
  std::uint64_t repeated = 0;     // came twice, or when nobody waited for them
  std::uint64_t asked_again = 0;  // chunks that were lost
  std::uint64_t absent = 0;       // items that the writer does not have
  std::uint64_t impossible = 0;   // chunks that cannot be right
};

/// Fetches the items of one writer: the newest of each stream in turn, then what is older. An item that has
/// been begun is finished first, so a slow link still carries whole ones, as fresh as it can.
///
/// Has no clock and no thread: whoever owns it sends what due() returns and calls it again at next_due(), and
/// after each offer or chunk.
class Receiver {
 public:
  /// Without a call of want() a stream is not asked for.
  void want(Stream stream, bool only_newest) { streams_[index(stream)] = {Wanted(only_newest)}; }
  /// The reader has this one already.
  void have(const ItemId& item);

  void offer(const Offer& offer);
  /// @return the item, if this chunk completes it
  std::optional<Item> take(const Chunk& chunk, Time now);
  /// What to ask for now.
  std::vector<Request> due(Time now);
  /// When due() has something to say even if nothing comes until then.
  [[nodiscard]] std::optional<Time> next_due() const;

  /// Items that are offered and not here yet.
  [[nodiscard]] std::size_t lacking(Stream stream) const;
  [[nodiscard]] const ReceiverStatistics& statistics() const { return statistics_; }
  [[nodiscard]] const Window& window() const { return window_; }

 private:
  static constexpr std::size_t kMostBegun = 8;  // items at a time

  struct Asked {
    ItemId item;
    std::uint32_t chunk = 0;
    Time at{};
    bool again = false;  // not for the first time
  };
  using Orders = std::map<std::uint64_t, Asked>;  // by order of asking

  static std::size_t index(Stream stream) { return static_cast<std::size_t>(stream); }
  struct Begun {
    std::uint64_t turn = 0;  // counts up with each item that is begun
    Assembly assembly;
  };
  struct StreamState {
    Wanted wanted;
    std::uint64_t turn = 0;  // of its latest item
  };

  void arrive(const Chunk& chunk, Time now);
  void add(const Chunk& chunk, Assembly& assembly);
  void give_up_lost(Time now);
  void lose(Orders::iterator asked);
  void forget_asked(const ItemId& item, std::uint32_t first_chunk);
  [[nodiscard]] std::optional<std::pair<ItemId, std::uint32_t>> next_chunk();
  [[nodiscard]] std::optional<ItemId> next_item() const;

  std::array<std::optional<StreamState>, kStreams> streams_;
  std::map<ItemId, Begun> begun_;
  Orders in_flight_;
  std::map<std::pair<ItemId, std::uint32_t>, std::uint64_t> order_of_;  // of what is in flight
  std::uint64_t next_order_ = 0;
  std::uint64_t overtaken_ = 0;  // orders below it that are in flight
  std::uint64_t turn_ = 0;
  Time last_arrival_{};
  Window window_;
  ReceiverStatistics statistics_;
};

}  // namespace rds::transfer
