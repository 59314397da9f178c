// SPDX-License-Identifier: Apache-2.0
#include "common/transfer/window.hpp"

#include <algorithm>
#include <cmath>

namespace rds::transfer {
namespace {

using std::chrono::milliseconds;

constexpr Time kShortestTimeout = milliseconds(60);
constexpr Time kLongestTimeout = std::chrono::seconds(1);
constexpr Time kFirstTimeout = milliseconds(300);
constexpr Time kShortestReordering = milliseconds(3);
constexpr double kLossMemory = 0.99;
constexpr double kShrink = 0.7;
constexpr double kFastestShrink = 0.5;  // chunks per chunk: a third in a round trip (LEDBAT++)

}  // namespace

Time Window::timeout() const {
  const Time once =
      smoothed_ == Time{} ? kFirstTimeout : std::max(smoothed_ + 4 * variation_, kShortestTimeout);
  return std::min(once * (1 << std::min(silences_, 8)), kLongestTimeout);
}

double Window::bits_per_s() const {
  if (smoothed_ == Time{}) return 0;
  return chunks_ * 8 * kChunkBytes / std::chrono::duration<double>(smoothed_).count();
}

Time Window::reordering() const {
  return std::max(4 * variation_, kShortestReordering);
}

void Window::arrived(Time now, Time round_trip, bool again, std::size_t in_flight) {
  if (!again) measure(now, round_trip);  // Karn
  silences_ = 0;
  loss_ *= kLossMemory;
  const bool used = static_cast<double>(in_flight) >= chunks_ / 2;
  const double off_target = 1.0 - std::chrono::duration<double>(queue()) / target_queue_;
  if (doubling_ && off_target < 0.5) doubling_ = false;
  if (off_target > 0 && !used) return;  // what is not used shows nothing
  const double change = off_target > 0 ? off_target / chunks_ : std::max(off_target, -1.0) * kFastestShrink;
  chunks_ += doubling_ ? 1.0 : change;
  chunks_ = std::clamp(chunks_, kSmallest, kLargest);
}

void Window::lost(Time now) {
  loss_ = loss_ * kLossMemory + (1 - kLossMemory);
  if (loss_ < kCongestedLoss || now < next_shrink_) return;
  doubling_ = false;
  chunks_ = std::max(chunks_ * kShrink, kSmallest);
  next_shrink_ = now + smoothed_;
}

void Window::silent() {
  ++silences_;
  if (is_stream_) return;  // which looks after the link itself, and may only be late
  chunks_ = kSmallest;
  doubling_ = true;
}

void Window::measure(Time now, Time round_trip) {
  const bool first = smoothed_ == Time{};
  variation_ = first ? round_trip / 2 : (3 * variation_ + std::chrono::abs(smoothed_ - round_trip)) / 4;
  smoothed_ = first ? round_trip : (7 * smoothed_ + round_trip) / 8;
  if (first) latest_.fill(round_trip);
  latest_[next_latest_++ % latest_.size()] = round_trip;
  if (now - base_since_ > kBasePeriod) {
    base_ = {Time::max(), base_[0]};
    base_since_ = now;
  }
  base_[0] = std::min(base_[0], round_trip);
}

/// How long chunks wait on the way at present.
Time Window::queue() const {
  return *std::ranges::min_element(latest_) - *std::ranges::min_element(base_);
}

}  // namespace rds::transfer
