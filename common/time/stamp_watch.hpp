// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "common/time/stamp_step.hpp"

namespace rds::time {

/// What is to become of a message, by its stamp.
enum class StampVerdict : std::uint8_t {
  kOn,     // use it
  kGap,    // use it; nothing came for a while
  kBreak,  // use it; time has broken: it goes on from here
  kLate,   // drop it: repeated, or overtaken
  kDoubt   // drop it: of another time than those before, alone so far
};

/// Decides from stamp to stamp whether time goes on.
///
/// A stamp far ahead (StampStep::kAhead) or back is doubted. If the next one is back in the old time, it was a
/// lone error and leaves no trace. If the next one goes on from it, time has broken there: a clock was set, a
/// recording begins again, the camera was away. So a break costs one message, and none ever waits for another.
class StampWatch {
 public:
  /// @param doubts  if false, time breaks at once: for senders that are known to send in order.
  explicit StampWatch(bool doubts = true) : doubts_(doubts) {}

  StampVerdict take(std::int64_t stamp_ns);

  /// By how much time went on, or back (negative), at the last break [ns].
  [[nodiscard]] std::int64_t break_ns() const { return break_ns_; }

 private:
  StampVerdict doubt(std::int64_t stamp_ns);
  StampVerdict break_at(std::int64_t stamp_ns);

  bool doubts_;
  std::optional<std::int64_t> newest_ns_;
  std::optional<std::int64_t> doubted_ns_;
  std::int64_t break_ns_ = 0;
};

}  // namespace rds::time
