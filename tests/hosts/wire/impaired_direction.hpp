// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <queue>
#include <random>
#include <vector>

namespace rds::test {

/// What a link does to each frame, independently of all others.
struct Impairment {
  double delay_ms = 0;
  double jitter_ms = 0;  // ± around the delay, uniform; frames may overtake each other
  double loss = 0;       // probability
};

/// One direction of a link: frames go in when they arrive and come out when they are due. Has no clock.
class ImpairedDirection {
 public:
  using Time = std::chrono::nanoseconds;  // since any fixed moment
  using Frame = std::vector<std::uint8_t>;

  ImpairedDirection(const Impairment& impairment, std::uint32_t seed)
      : impairment_(impairment), random_(seed) {}

  void push(Frame frame, Time now);
  /// The next frame that is due; those due at the same time in the order of their arrival.
  std::optional<Frame> pop(Time now);
  /// When pop() has a frame, if no other arrives until then.
  [[nodiscard]] std::optional<Time> next_due() const;

 private:
  struct Waiting {
    Time due;
    std::uint64_t order;
    Frame frame;
    bool operator>(const Waiting& other) const {
      return due != other.due ? due > other.due : order > other.order;
    }
  };

  Impairment impairment_;
  std::mt19937 random_;
  std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>> waiting_;
  std::uint64_t arrived_ = 0;
};

}  // namespace rds::test
