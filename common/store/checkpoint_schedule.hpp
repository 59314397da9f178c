// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>

namespace rds::store {

/// When a service hands its next checkpoint over: after its period, or sooner with a new keyframe, whose
/// place nobody else remembers. Used by one thread.
class CheckpointSchedule {
 public:
  explicit CheckpointSchedule(double period_s) : period_(period_s) {}

  void note_keyframe() { has_keyframe_ = true; }
  /// What has changed must not get lost: the next checkpoint is due at once.
  void hurry() { handed_over_ = {}; }
  [[nodiscard]] bool is_due() const {
    return Clock::now() - handed_over_ >= (has_keyframe_ ? std::min(period_, kShortest) : period_);
  }
  /// A checkpoint is handed over now.
  void restart() {
    handed_over_ = Clock::now();
    has_keyframe_ = false;
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::duration<double> kShortest{1};

  std::chrono::duration<double> period_;
  Clock::time_point handed_over_ = Clock::now();
  bool has_keyframe_ = false;  // since then
};

}  // namespace rds::store
