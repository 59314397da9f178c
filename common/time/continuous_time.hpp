// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

namespace rds::time {

/// A time for stamps that goes on where they go back, so that what is measured between two of them is never
/// negative for long. While stamps go on it is the stamps.
///
/// Where stamps go back (StampStep::kBack) it goes on by kUnknownNs, because nobody knows how long that took;
/// where they go ahead by more than kLongestNs, by that. A late stamp has an earlier time, by as much.
class ContinuousTime {
 public:
  static constexpr std::int64_t kUnknownNs = 1'000'000'000;
  static constexpr std::int64_t kLongestNs = 3'600'000'000'000;

  struct Moment {
    std::int64_t time_ns = 0;
    bool went_back = false;  // the stamp did
  };

  /// A stamp and its time.
  struct Mark {
    std::int64_t stamp_ns = 0;
    std::int64_t time_ns = 0;
  };

  ContinuousTime() = default;
  /// Goes on from where another one was.
  explicit ContinuousTime(std::optional<Mark> newest) : newest_(newest) {}

  /// The moment of a stamp if it came next; that of the newest stamp stays what it was.
  [[nodiscard]] Moment at(std::int64_t stamp_ns) const;
  /// The stamp has come.
  Moment go_to(std::int64_t stamp_ns);
  /// The newest stamp since they last went back; nullopt before the first.
  [[nodiscard]] const std::optional<Mark>& newest() const { return newest_; }

 private:
  std::optional<Mark> newest_;
};

}  // namespace rds::time
