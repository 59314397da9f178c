// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "common/transfer/transfer.hpp"

namespace rds::transfer {

/// How many chunks may be asked for and not have come yet.
///
/// Follows the delay, as LEDBAT (RFC 6817): the window grows until its chunks wait on the way for as long as
/// they should, and shrinks, faster, where they wait for longer. What a link loses by chance does not shrink
/// it, only loss of more than kCongestedLoss.
class Window {
 public:
  explicit Window(Way way = Way::kDatagrams)
      : is_stream_(way == Way::kStream), target_queue_(is_stream_ ? kStreamQueue : kQueue) {}

  [[nodiscard]] std::size_t chunks() const { return static_cast<std::size_t>(chunks_); }
  [[nodiscard]] Time round_trip() const { return smoothed_; }
  /// What the link is taken to carry, of chunks [bit/s]; 0 before anything was measured.
  [[nodiscard]] double bits_per_s() const;
  /// Without an arrival for so long everything that was asked for counts as lost (RFC 6298).
  [[nodiscard]] Time timeout() const;
  /// By how much chunks may overtake each other.
  [[nodiscard]] Time reordering() const;

  /// A chunk has come. @param again  it was asked for more than once, so the round trip may be of another
  /// time. @param in_flight  chunks that were asked for and had not come
  void arrived(Time now, Time round_trip, bool again, std::size_t in_flight);
  void lost(Time now);
  /// The timeout has passed.
  void silent();

 private:
  static constexpr Time kQueue = std::chrono::milliseconds(30);
  static constexpr Time kStreamQueue = std::chrono::milliseconds(100);  // jitter of 10 ms alone looks like 30
  static constexpr Time kBasePeriod = std::chrono::seconds(20);
  static constexpr double kSmallest = 4;
  static constexpr double kFirst = 32;      // 38 kB
  static constexpr double kLargest = 4096;  // 5 MB
  static constexpr double kCongestedLoss = 0.15;

  void measure(Time now, Time round_trip);
  [[nodiscard]] Time queue() const;

  bool is_stream_;
  Time target_queue_;
  double chunks_ = kFirst;
  bool doubling_ = true;  // until the delay first grows: slow start
  double loss_ = 0;       // share of the latest hundred chunks
  Time next_shrink_{};    // at most once a round trip
  Time smoothed_{};       // RFC 6298; 0: nothing measured
  Time variation_{};
  int silences_ = 0;                                    // in a row
  std::array<Time, 2> base_{Time::max(), Time::max()};  // shortest of this period, of the one before
  Time base_since_{};
  std::array<Time, 8> latest_{};  // round trips; their shortest is free of jitter
  std::size_t next_latest_ = 0;
};

}  // namespace rds::transfer
