// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace rds::service {

/// Notices a thread that hangs, from another thread that looks at it again and again.
///
/// Time in which the looking thread did not run either does not count: a process that was stopped for a minute and
/// goes on does not hang.
class HangWatch {
 public:
  /// @param limit_s  silence that is too long [s]; 0: none is.
  explicit HangWatch(double limit_s) : limit_s_(limit_s) {}

  /// @param silent_s  since the thread last said that it is alive [s].
  /// @param since_last_look_s  since the last call [s].
  /// @return whether it was seen to be silent for longer than the limit.
  bool look(double silent_s, double since_last_look_s) {
    seen_silent_s_ = std::min(silent_s, seen_silent_s_ + std::min(since_last_look_s, kLongestLookS));
    return limit_s_ > 0 && seen_silent_s_ > limit_s_;
  }

 private:
  static constexpr double kLongestLookS = 0.2;  // [s]; looks are ten in a second
  double limit_s_;
  double seen_silent_s_ = 0;
};

}  // namespace rds::service
