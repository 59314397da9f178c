// SPDX-License-Identifier: Apache-2.0
#include "services/viewer/core/foxglove/foxglove_client.hpp"

#include <algorithm>

namespace rds::viewer::foxglove {

FoxgloveClient::FoxgloveClient(const std::vector<Channel>& channels, std::string_view session,
                               Changed subscribed)
    : channels_(channels),
      subscribed_(std::move(subscribed)),
      texts_{server_info(session), advertise(channels)} {}

bool FoxgloveClient::receive(std::string_view message, bool binary) {
  if (binary) return false;  // clients' messages, parameters' and services' requests: not offered
  const Subscriptions before = subscriptions_;
  const Said said = take(message, channels_, subscriptions_);
  std::erase_if(waiting_, [this](const Sample& sample) { return !hears(sample.channel); });
  waiting_bytes_ = 0;
  for (const Sample& sample : waiting_) waiting_bytes_ += sample.bytes->size();
  for (const auto& [channel, id] : subscriptions_)
    if (!before.contains(channel)) subscribed_(*this, channel);
  return said == Said::kUnderstood;
}

void FoxgloveClient::push(const Sample& sample) {
  if (!hears(sample.channel)) return;
  const auto same = std::ranges::count(waiting_, sample.channel, &Sample::channel);
  if (static_cast<std::size_t>(same) >= kMostWaiting) drop_oldest(sample.channel);
  while (!waiting_.empty() && waiting_bytes_ + sample.bytes->size() > kMostWaitingBytes)
    drop_oldest(waiting_.front().channel);
  waiting_bytes_ += sample.bytes->size();
  waiting_.push_back(sample);
}

void FoxgloveClient::drop_oldest(std::uint32_t channel) {
  const auto oldest = std::ranges::find(waiting_, channel, &Sample::channel);
  waiting_bytes_ -= oldest->bytes->size();
  waiting_.erase(oldest);
  ++skipped_;
}

std::optional<Outgoing> FoxgloveClient::next() {
  if (!texts_.empty()) {
    const std::string text = std::move(texts_.front());
    texts_.pop_front();
    return Outgoing{std::make_shared<const Bytes>(text.begin(), text.end()), false};
  }
  if (waiting_.empty()) return std::nullopt;
  const Sample sample = std::move(waiting_.front());
  waiting_.pop_front();
  waiting_bytes_ -= sample.bytes->size();
  return Outgoing{std::make_shared<const Bytes>(
      message_data(subscriptions_.at(sample.channel), sample.time_ns, *sample.bytes))};
}

}  // namespace rds::viewer::foxglove
