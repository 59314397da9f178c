// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/topic/topic_reader.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include <fmt/format.h>

#include "tools/rds/cli/wait.hpp"

namespace rds::tools {
namespace {
constexpr std::size_t kMostMessages = 1000;
constexpr std::size_t kMostStamps = 1'000'000;
constexpr std::chrono::milliseconds kMatchTime{500};

// A reader that wants less than a writer offers matches it; one that wants more does not.
constexpr bus::Qos kReliableWithHistory{
    .reliable = true, .transient_local = true, .depth = 0, .max_samples = 1000};
constexpr bus::Qos kReliable{.reliable = true, .depth = 0, .max_samples = 1000};
constexpr bus::Qos kBestEffort{.reliable = false, .depth = 100};

/// DDS type of a topic's publishers; nullopt while there is none.
std::optional<std::string> published_type(const bus::Participant& participant, const std::string& topic) {
  for (const auto& endpoint : participant.discovered())
    if (endpoint.publisher && endpoint.topic == topic) return endpoint.type;
  return std::nullopt;
}

}  // namespace

tl::expected<std::unique_ptr<TopicReader>, std::string> TopicReader::open(bus::Participant& participant,
                                                                          const std::string& topic,
                                                                          bool keep_messages,
                                                                          Clock::time_point deadline,
                                                                          const std::stop_token& stop) {
  std::optional<std::string> type_name;
  const bool found = wait_until(deadline, stop, [&] {
    type_name = published_type(participant, participant.full_name(topic));
    return type_name.has_value();
  });
  if (!found)
    return tl::unexpected(fmt::format("{}: nobody publishes it, expected a publisher in time", topic));
  const auto* type = messages::find_message_type(*type_name);
  if (type == nullptr)
    return tl::unexpected(
        fmt::format("{}: its type {} is unknown here, expected one of idl/", topic, *type_name));
  std::unique_ptr<TopicReader> reader(new TopicReader(*type, keep_messages));
  reader->subscribe(participant, topic, stop);
  return reader;
}

void TopicReader::subscribe(bus::Participant& participant, const std::string& topic,
                            const std::stop_token& stop) {
  for (const auto& qos : {kReliableWithHistory, kReliable, kBestEffort}) {
    subscription_.reset();
    subscription_ = participant.make_subscription(
        topic, *type_->ops, qos,
        [this](std::shared_ptr<const void> message, const bus::ParticipantId&) { push(std::move(message)); });
    if (wait_until(Clock::now() + kMatchTime, stop, [&] { return subscription_->matched() > 0; })) return;
  }
}

void TopicReader::push(std::shared_ptr<const void> message) {
  const std::size_t bytes = type_->ops->encoded_size(message.get());
  if (!keep_messages_) message.reset();
  {
    const std::lock_guard lock(mutex_);
    if (arrivals_.size() >= (keep_messages_ ? kMostMessages : kMostStamps)) {
      arrivals_.pop_front();
      ++dropped_;
    }
    arrivals_.push_back({std::move(message), bytes, Clock::now()});
  }
  changed_.notify_one();
}

std::optional<Arrival> TopicReader::next(Clock::time_point deadline, const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  if (!changed_.wait_until(lock, stop, deadline, [this] { return !arrivals_.empty(); })) return std::nullopt;
  Arrival arrival = std::move(arrivals_.front());
  arrivals_.pop_front();
  return arrival;
}

std::size_t TopicReader::dropped() const {
  const std::lock_guard lock(mutex_);
  return dropped_;
}

}  // namespace rds::tools
