// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

namespace rds::service {

/// Notices a process that was stopped for so long that the bus gave it up, and that hears of nobody since.
/// Seen with Fast DDS on a loaded machine, after some stops of about its lease beside a flood of messages: it
/// finds nobody, and even who comes anew does not find it, though none of its threads hangs. Why is not
/// known.
class DeafnessWatch {
 public:
  static constexpr double kStoppedS = 5;    // without a look; the bus gives up who is silent for 10
  static constexpr double kPatienceS = 20;  // until others are found again

  /// @param hears_others  whether other services are heard of now. @param since_last_look_s  [s]
  /// @return whether others were heard of before the last stop, and none is kPatienceS after it.
  bool look(bool hears_others, double since_last_look_s) {
    const bool was_stopped = since_last_look_s > kStoppedS;
    if (was_stopped) {
      heard_others_ = deaf_for_s_ ? heard_others_ : hears_others_;
      deaf_for_s_ = 0;
    } else if (deaf_for_s_) {
      *deaf_for_s_ += since_last_look_s;
    }
    hears_others_ = hears_others;
    if (!deaf_for_s_ || *deaf_for_s_ < kPatienceS) return false;
    deaf_for_s_.reset();
    return heard_others_ && !hears_others;
  }

 private:
  bool hears_others_ = false;
  bool heard_others_ = false;         // before the stop
  std::optional<double> deaf_for_s_;  // since the stop, perhaps; nullopt: nothing is doubted
};

}  // namespace rds::service
