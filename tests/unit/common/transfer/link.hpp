// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <random>

#include "common/transfer/transfer.hpp"

namespace rds::transfer {

/// Time and what happens at which moment, in order.
class Events {
 public:
  [[nodiscard]] Time now() const { return now_; }
  void at(Time time, std::function<void()> happens) {
    events_.emplace(std::max(time, now_), std::move(happens));
  }
  /// Until nothing is left to happen, or `end`.
  void run(Time end) {
    while (!events_.empty() && events_.begin()->first <= end) {
      auto event = events_.extract(events_.begin());
      now_ = event.key();
      event.mapped()();
    }
    now_ = end;
  }

 private:
  Time now_{};
  std::multimap<Time, std::function<void()>> events_;
};

/// One direction of a link.
struct LinkQuality {
  double mbit_per_s = 1000;
  Time delay{};
  Time jitter{};                        // of the delay, up to so much more or less
  double loss = 0;                      // share of datagrams
  bool in_order = false;                // as a stream: what is late holds up what follows it
  std::size_t queue_bytes = 1U << 20U;  // of the bottleneck; what finds it full is lost
};

class Link {
 public:
  Link(Events& events, const LinkQuality& quality, unsigned seed)
      : events_(events), quality_(quality), random_(seed) {}

  void send(std::size_t bytes, std::function<void()> arrives) {
    const auto busy = std::max(free_at_ - events_.now(), Time{});
    const double queued = std::chrono::duration<double>(busy).count() * quality_.mbit_per_s * 1e6 / 8;
    if (queued + static_cast<double>(bytes) > static_cast<double>(quality_.queue_bytes)) return;
    sent_bytes_ += bytes;
    free_at_ = std::max(free_at_, events_.now()) +
               Time(static_cast<std::int64_t>(static_cast<double>(bytes) * 8e3 / quality_.mbit_per_s));
    if (std::uniform_real_distribution<>(0, 1)(random_) < quality_.loss || !connected) return;
    const double share = std::uniform_real_distribution<>(-1, 1)(random_);
    const Time jitter(static_cast<std::int64_t>(share * static_cast<double>(quality_.jitter.count())));
    const Time arrival = free_at_ + quality_.delay + jitter;
    latest_ = std::max(latest_, arrival);
    events_.at(quality_.in_order ? latest_ : arrival, std::move(arrives));
  }

  bool connected = true;
  [[nodiscard]] std::size_t sent_bytes() const { return sent_bytes_; }

 private:
  Events& events_;
  LinkQuality quality_;
  std::mt19937 random_;
  Time free_at_{};
  Time latest_{};  // arrival so far
  std::size_t sent_bytes_ = 0;
};

}  // namespace rds::transfer
