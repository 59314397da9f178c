// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "common/bus/participant.hpp"

namespace rds::transfer {

/// Several writers of one topic, used in turn. A best-effort reader throws away what later messages of the
/// same writer have overtaken (RTPS 2.5, 8.4.12.1), and on a link with jitter that is nearly everything.
/// The writers are made with the first message: where nothing is sent nobody has to learn of them.
template <class Message>
class Lanes {
 public:
  using Advertise = std::function<bus::Publisher<Message>()>;

  explicit Lanes(Advertise advertise) : advertise_(std::move(advertise)) {}

  void write(const Message& message) {
    while (lanes_.size() < kLanes) lanes_.push_back(advertise_());
    lanes_[next_++ % kLanes].write(message);
  }

 private:
  /// 1.2 kB each: on 20 Mbit/s what 15 ms carry.
  static constexpr std::size_t kLanes = 32;

  Advertise advertise_;
  std::vector<bus::Publisher<Message>> lanes_;
  std::size_t next_ = 0;
};

}  // namespace rds::transfer
