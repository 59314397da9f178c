// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <thread>

#include "common/concurrency/mailbox.hpp"
#include "common/service/peers/peers.hpp"
#include "common/service/service.hpp"
#include "common/transfer/bus/channel.hpp"
#include "common/transfer/bus/far_reader.hpp"
#include "common/transfer/bus/host.hpp"
#include "common/transfer/item_maker.hpp"
#include "common/transfer/item_store.hpp"
#include "rds_msgs/msg/TransferOffer.h"
#include "rds_msgs/msg/TransferRequest.h"

namespace rds::transfer {

/// What a service has for readers on other machines, and the thread that answers them. What is offered is
/// told every second, in case nobody listened. Items are shared, or made by an ItemMaker when they are asked
/// for. What is shared is made at once, so that who joins later can have it too; not in a process on the
/// loopback interface, where nobody else can come.
class ItemServer {
 public:
  using Bytes = ItemStore::Bytes;
  /// For how much there is room; older items are lost.
  struct Room {
    std::size_t memory_bytes = 0;
    std::size_t file_bytes = 0;  // of what is older, in a temporary file
  };

  /// @param host  for tests.
  ItemServer(service::ServiceContext& context, topics::Process process, const Channel& channel,
             const Room& room, std::uint64_t host = this_host());
  /// @param maker  outlives this.
  ItemServer(service::ServiceContext& context, topics::Process process, const Channel& channel,
             ItemMaker& maker, std::uint64_t host = this_host());

  /// Another map: its items are told apart by its epoch, those of before are forgotten. Of any thread.
  void begin(std::uint64_t map_epoch) { shared_.push({map_epoch, {}, 0, {}}); }
  /// Offers an item of the map's epoch, of any thread. `make` is called on the server's thread, if at all; an
  /// empty result, an exception, or too many that wait to be made: the item is lost.
  void share(std::uint64_t map_epoch, Stream stream, std::uint64_t number, std::function<Bytes()> make);

 private:
  struct Shared {
    std::uint64_t map_epoch = 0;
    Stream stream{};
    std::uint64_t number = 0;
    std::function<Bytes()> make;  // empty: an epoch begins
  };
  using Request = std::shared_ptr<const rds_msgs::msg::TransferRequest>;

  ItemServer(service::ServiceContext& context, topics::Process process, const Channel& channel,
             const Room& room, ItemMaker* maker, std::uint64_t host);
  FarReader& add_reader(topics::Process process, const std::string& topic);
  void warn_of(topics::Process process);
  [[nodiscard]] FarReader* reader_of(const rds_msgs::msg::TransferRequest& request);
  void forget_silent();
  [[nodiscard]] bool was_asked() const { return now() - asked_ < kSilent; }
  void run(const std::stop_token& stop);
  void take(const Shared& shared);
  [[nodiscard]] Bytes made(const Shared& shared);
  void look();
  void write(const ItemMaker::Offers& offers);
  void answer(const rds_msgs::msg::TransferRequest& request);
  [[nodiscard]] const Bytes* find(Stream stream, std::uint64_t number);
  void send(const Chunk& chunk, Stream stream, std::uint64_t reader, FarReader& to);

  /// Who says nothing for so long is gone: readers say every second that they are there.
  static constexpr std::chrono::seconds kSilent{10};

  service::ServiceContext& context_;
  topics::Process process_;
  Channel channel_;
  ItemMaker* maker_;  // nullptr: items are shared
  std::uint64_t host_;
  Time asked_{-kSilent};  // for the last time
  Time looked_{};         // for something new
  ItemMaker::Offers offered_;
  Time offered_at_{};
  std::uint64_t map_epoch_ = 0;
  ItemStore items_;
  std::map<std::string, FarReader> readers_;  // by topic
  service::Peers peers_;
  bus::Publisher<rds_msgs::msg::TransferOffer> offers_;
  service::Diagnostics::Counter& chunks_sent_;
  service::Diagnostics::Counter& chunks_sent_again_;
  concurrency::Mailbox mailbox_;
  concurrency::Inbox<Shared> shared_;
  concurrency::Inbox<Request> requests_;
  bus::Subscription subscription_;
  std::jthread thread_;
};

}  // namespace rds::transfer
