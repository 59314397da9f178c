// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <thread>
#include <vector>

#include "common/concurrency/mailbox.hpp"
#include "common/service/peers/instance_owners.hpp"
#include "common/service/peers/peers.hpp"
#include "common/service/service.hpp"
#include "common/transfer/bus/backlog.hpp"
#include "common/transfer/bus/channel.hpp"
#include "common/transfer/bus/host.hpp"
#include "common/transfer/bus/lanes.hpp"
#include "common/transfer/hello.hpp"
#include "common/transfer/patience.hpp"
#include "common/transfer/receiver.hpp"
#include "rds_msgs/msg/TransferChunk.h"
#include "rds_msgs/msg/TransferOffer.h"
#include "rds_msgs/msg/TransferRequest.h"

namespace rds::transfer {

/// Fetches what a service on another machine offers, on a thread of its own.
class ItemClient {
 public:
  /// Where the service is whose offers are followed; kHere too for one that writes for its own machine and
  /// offers nothing (Patience).
  enum class Where : std::uint8_t { kUnknown, kHere, kElsewhere };
  struct Callbacks {
    std::function<void(std::uint64_t map_epoch, Item)> item;  // a whole item, on the client's thread
    std::function<void(Where)> where = [](Where) {};          // on the client's thread, when it changes
    /// Whether kMostBegun more items can be taken; else no further ones are asked for. On the client's
    /// thread.
    std::function<bool()> has_room = [] { return true; };
    /// For items that are made when they are asked for: the number of the next one, if any is wanted. Called
    /// with each offer, and when an item has come; never while one is on its way. Empty: all are fetched that
    /// are offered.
    std::function<std::optional<std::uint64_t>(std::uint64_t map_epoch, const Offer&)> next = {};
    /// How long an item is offered before it is asked for: what a link carries then is for readers in more of
    /// a hurry.
    Time gives_way = {};
  };

  /// @param stream  that is wanted. @param host  for tests.
  ItemClient(service::ServiceContext& context, topics::Process process, const Channel& channel, Stream stream,
             Order order, Callbacks callbacks, std::uint64_t host = this_host());

 private:
  using Offers = std::shared_ptr<const rds_msgs::msg::TransferOffer>;
  using Chunks = std::shared_ptr<const rds_msgs::msg::TransferChunk>;

  struct Self {
    topics::Process process;
    Stream stream;
    Order order;
    std::uint64_t host;
  };
  struct TimedOffer {
    Time due{};  // to be asked for
    std::optional<Offer> offer = {};
  };
  /// Whose offers are followed.
  struct Source {
    service::FollowedWriter followed;
    std::uint64_t instance = 0;
    std::uint64_t map_epoch = 0;
    std::deque<TimedOffer> offers = {};  // that are not due yet
    std::optional<Offer> offer = {};     // the latest that was
    Where where = Where::kUnknown;
    Patience patience = {};
  };
  /// For diagnostics.
  struct Figures {
    Backlog backlog;
    GivenUp given_up;
    std::atomic<std::uint64_t> followed = 0;  // instance
    std::atomic<std::uint64_t> round_trip_us = 0;
    std::atomic<std::uint64_t> link_kbit_s = 0;
    std::atomic<std::uint64_t> asked_again = 0;
    std::atomic<std::uint64_t> impossible = 0;
  };
  struct Inboxes {
    concurrency::Mailbox mailbox;
    concurrency::Inbox<Offers> offers;
    concurrency::Inbox<Chunks> chunks;
    Inboxes();
  };

  void tell(service::Diagnostics& diagnostics);
  [[nodiscard]] Receiver new_receiver() const;
  void run(const std::stop_token& stop);
  [[nodiscard]] std::chrono::milliseconds until_due() const;
  void step();
  void take(const rds_msgs::msg::TransferOffer& offers);
  void follow(const rds_msgs::msg::TransferOffer& offers);
  void hear_due_offers(Time now);
  void want();
  void take(const rds_msgs::msg::TransferChunk& chunk, Time now);
  [[nodiscard]] bool is_here_without_offer(Time now);
  void be(Where where);
  void ask(Time now);
  void send(std::span<const Request> requests);
  [[nodiscard]] std::uint64_t round_trip_us() const;
  [[nodiscard]] std::uint64_t link_kbit_s() const;

  service::ServiceContext& context_;
  Channel channel_;
  Self self_;
  Callbacks callbacks_;
  service::InstanceOwners owners_;
  Source source_;
  Receiver receiver_;
  std::uint64_t last_wanted_ = 0;  // number that the receiver has been told to fetch
  Hello hello_;
  Figures figures_;
  Lanes<rds_msgs::msg::TransferRequest> requests_;
  Inboxes inboxes_;
  std::vector<bus::Subscription> subscriptions_;
  std::jthread thread_;
};

}  // namespace rds::transfer
