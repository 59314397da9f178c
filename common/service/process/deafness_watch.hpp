// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace rds::service {

/// Notices a process that was stopped for so long that the bus gave it up, and that hears of nobody since:
/// now and then (4 of 21 stops of ten seconds beside a flood) two participants of Fast DDS that forget each
/// other in turn, and not at once, do not find each other again. Started again, they do.
class DeafnessWatch {
 public:
  static constexpr double kStoppedS =
      5;  // a process that did not look for so long was stopped; the bus's lease is 10
  static constexpr double kPatienceS = 20;  // until others are found again

  /// @param others  services that are heard of now.
  /// @param since_last_look_s  [s]
  /// @return whether there were others before the last stop, and none has been heard of for kPatienceS after
  /// it.
  bool look(std::size_t others, double since_last_look_s) {
    if (since_last_look_s > kStoppedS) {
      if (!is_recovering_) had_others_ = others_ > 0;
      is_recovering_ = true;
      recovering_s_ = 0;
    }
    others_ = others;
    if (!is_recovering_) return false;
    recovering_s_ += since_last_look_s > kStoppedS ? 0 : since_last_look_s;
    if (recovering_s_ < kPatienceS) return false;
    is_recovering_ = false;
    return had_others_ && others == 0;
  }

 private:
  std::size_t others_ = 0;
  bool had_others_ = false;
  bool is_recovering_ = false;
  double recovering_s_ = 0;  // since the stop
};

}  // namespace rds::service
