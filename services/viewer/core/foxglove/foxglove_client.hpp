// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "services/viewer/core/foxglove/channels.hpp"
#include "services/viewer/core/frames/conversation.hpp"

namespace rds::viewer::foxglove {

/// A message of the bus, as it is on the wire.
struct Sample {
  std::uint32_t channel = 0;
  std::uint64_t time_ns = 0;  // when it came
  std::shared_ptr<const std::vector<std::uint8_t>> bytes;
};

/// One client of Foxglove's protocol: is told the channels, and gets the messages of those to which it
/// subscribes. What waits for a slow client is bounded: of each channel the oldest go first.
class FoxgloveClient final : public Conversation {
 public:
  /// Of one channel; 100 are 3 s of poses at 30 Hz.
  static constexpr std::size_t kMostWaiting = 100;
  /// Of all; a single larger message alone is sent all the same.
  static constexpr std::size_t kMostWaitingBytes = 8 << 20;

  using Changed = std::function<void(FoxgloveClient& client, std::uint32_t channel)>;

  /// @param channels  outlive this. @param subscribed  called for each channel that the client begins to
  /// hear.
  FoxgloveClient(const std::vector<Channel>& channels, std::string_view session, Changed subscribed);

  bool receive(std::string_view message, bool binary) override;
  std::optional<Outgoing> next() override;

  [[nodiscard]] bool hears(std::uint32_t channel) const { return subscriptions_.contains(channel); }
  void push(const Sample& sample);
  /// Messages that went, as the client was too slow.
  [[nodiscard]] std::uint64_t skipped() const { return skipped_; }

 private:
  void drop_oldest(std::uint32_t channel);

  const std::vector<Channel>& channels_;
  Changed subscribed_;
  Subscriptions subscriptions_;
  std::deque<std::string> texts_;
  std::deque<Sample> waiting_;
  std::size_t waiting_bytes_ = 0;
  std::uint64_t skipped_ = 0;
};

}  // namespace rds::viewer::foxglove
