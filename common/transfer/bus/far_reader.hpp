// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "common/service/diagnostics.hpp"
#include "common/transfer/bus/backlog.hpp"
#include "common/transfer/bus/lanes.hpp"
#include "common/transfer/sent_chunks.hpp"
#include "rds_msgs/msg/TransferChunk.h"
#include "rds_msgs/msg/TransferRequest.h"

namespace rds::transfer {

/// Readers of one topic of chunks, as their server knows them.
class FarReader {
 public:
  FarReader(std::size_t lanes, Lanes<rds_msgs::msg::TransferChunk>::Advertise advertise)
      : chunks_(lanes, std::move(advertise)) {}

  /// From now on figures tell what is sent to it, and what it says of itself; of several that hear the same
  /// topic, what one of them said last. @param name  before each of them: what it reads, and who it is.
  void show(service::Diagnostics& diagnostics, const std::string& name) {
    if (!figures_) figures_.emplace(diagnostics, name);
  }

  /// It has asked for something, or said that it is there.
  void hear(const rds_msgs::msg::TransferRequest& request, Time now);
  /// What it says of the items of the map that is offered.
  void hear_of_items(const rds_msgs::msg::TransferRequest& request, Time now);
  /// @return whether it was sent before
  bool send(const rds_msgs::msg::TransferChunk& message);
  /// Makes the writers, so that it learns of them before the first chunk.
  void open() { chunks_.open(); }

  /// When it said something for the last time.
  [[nodiscard]] Time heard() const { return heard_; }
  /// Of any thread.
  [[nodiscard]] const Backlog& backlog() const { return backlog_; }
  [[nodiscard]] const GivenUp& given_up() const { return given_up_; }
  /// Of the service that asked last.
  [[nodiscard]] std::uint64_t instance() const { return instance_; }

 private:
  using Counter = service::Diagnostics::Counter;
  struct Figures {
    Figures(service::Diagnostics& diagnostics, const std::string& name);
    Counter& chunks_sent;
    Counter& chunks_sent_again;
    Counter& items_arrived;
    Counter& items_lacking;
    Counter& items_given_up;
    Counter& round_trip_us;
    Counter& link_kbit_s;
  };

  Lanes<rds_msgs::msg::TransferChunk> chunks_;
  SentChunks sent_;
  Backlog backlog_;
  GivenUp given_up_;
  std::atomic<std::uint64_t> instance_ = 0;
  Time heard_{};
  std::optional<Figures> figures_;
};

}  // namespace rds::transfer
