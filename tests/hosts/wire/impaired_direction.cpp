// SPDX-License-Identifier: Apache-2.0
#include "tests/hosts/wire/impaired_direction.hpp"

#include <algorithm>
#include <utility>

namespace rds::test {

void ImpairedDirection::push(Frame frame, Time now) {
  std::uniform_real_distribution<double> chance(0, 1);
  const double jitter_ms = impairment_.jitter_ms * (2 * chance(random_) - 1);
  if (chance(random_) < impairment_.loss) return;
  const std::chrono::duration<double, std::milli> delay(std::max(0.0, impairment_.delay_ms + jitter_ms));
  waiting_.push({now + std::chrono::duration_cast<Time>(delay), arrived_++, std::move(frame)});
}

std::optional<ImpairedDirection::Frame> ImpairedDirection::pop(Time now) {
  if (waiting_.empty() || waiting_.top().due > now) return std::nullopt;
  Frame frame = waiting_.top().frame;
  waiting_.pop();
  return frame;
}

std::optional<ImpairedDirection::Time> ImpairedDirection::next_due() const {
  if (waiting_.empty()) return std::nullopt;
  return waiting_.top().due;
}

}  // namespace rds::test
