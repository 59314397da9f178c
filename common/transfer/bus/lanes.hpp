// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "common/bus/participant.hpp"

namespace rds::transfer {

/// Several writers of one topic, used in turn. On DDS a best-effort reader throws away what later messages of
/// the same writer have overtaken, and on a link with jitter that is nearly everything.
/// The writers are made with the first message: where nothing is sent nobody has to learn of them.
template <class Message>
class Lanes {
 public:
  using Advertise = std::function<bus::Publisher<Message>()>;

  /// @param count  at least 1: as many chunks as may overtake each other.
  Lanes(std::size_t count, Advertise advertise) : count_(count), advertise_(std::move(advertise)) {}

  void write(const Message& message) {
    open();
    lanes_[next_++ % count_].write(message);
  }
  /// Makes the writers, so that readers learn of them before the first message.
  void open() {
    while (lanes_.size() < count_) lanes_.push_back(advertise_());
  }

 private:
  std::size_t count_;
  Advertise advertise_;
  std::vector<bus::Publisher<Message>> lanes_;
  std::size_t next_ = 0;
};

}  // namespace rds::transfer
