// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <thread>

#include "common/concurrency/mailbox.hpp"
#include "common/service/service.hpp"
#include "common/transfer/bus/backlog.hpp"
#include "common/transfer/bus/host.hpp"
#include "common/transfer/bus/lanes.hpp"
#include "common/transfer/item_store.hpp"
#include "rds_msgs/msg/TransferChunk.h"
#include "rds_msgs/msg/TransferOffer.h"
#include "rds_msgs/msg/TransferRequest.h"

namespace rds::transfer {

/// What a service has for readers on other machines, and the thread that answers them. Nothing is made before
/// the first of them says that it is there; what is offered is told every second, in case nobody listened.
class ItemServer {
 public:
  using Bytes = ItemStore::Bytes;

  /// @param memory_bytes  of items.
  /// @param host  for tests.
  ItemServer(service::ServiceContext& context, topics::Process process, std::size_t memory_bytes,
             std::uint64_t host = this_host());

  /// Another map: its items are told apart by its epoch, those of before are forgotten. Of any thread.
  void begin(std::uint64_t map_epoch) { shared_.push({map_epoch, {}, 0, {}}); }
  /// Offers an item of the map's epoch, of any thread. `make` is called on the server's thread, if at all; an
  /// empty result or an exception: there is no such item.
  void share(std::uint64_t map_epoch, Stream stream, std::uint64_t number, std::function<Bytes()> make);

 private:
  struct Shared {
    std::uint64_t map_epoch = 0;
    Stream stream{};
    std::uint64_t number = 0;
    std::function<Bytes()> make;  // empty: an epoch begins
  };
  /// The readers of a topic.
  struct Reader {
    explicit Reader(Lanes<rds_msgs::msg::TransferChunk>::Advertise advertise)
        : chunks(std::move(advertise)) {}
    Lanes<rds_msgs::msg::TransferChunk> chunks;
    Backlog backlog;  // as it says
  };
  using Request = std::shared_ptr<const rds_msgs::msg::TransferRequest>;

  void add_reader(topics::Process process, topics::Process own);
  void run(const std::stop_token& stop);
  void take(const Shared& shared);
  void offer();
  void answer(const rds_msgs::msg::TransferRequest& request);
  void send(const Chunk& chunk, Stream stream, std::uint64_t reader,
            Lanes<rds_msgs::msg::TransferChunk>& to);

  service::ServiceContext& context_;
  std::uint64_t host_;
  std::atomic<bool> has_readers_ = false;
  std::uint64_t map_epoch_ = 0;
  ItemStore items_;
  std::map<topics::Process, Reader> readers_;
  bus::Publisher<rds_msgs::msg::TransferOffer> offers_;
  concurrency::Mailbox mailbox_;
  concurrency::Inbox<Shared> shared_;
  concurrency::Inbox<Request> requests_;
  bus::Subscription subscription_;
  std::jthread thread_;
};

}  // namespace rds::transfer
