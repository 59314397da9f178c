// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace rds::service {

/// Whether the tracker that is followed has begun another map: two messages have to say so. One alone may be
/// spoiled, and would end a map.
class EpochConfirmation {
 public:
  /// A message of another epoch. @param mark  tells it apart from other messages: a keyframe's id.
  /// @return whether this one or an earlier one was the second.
  bool confirm(std::uint64_t instance, std::uint64_t epoch, std::uint64_t mark) {
    if (instance != instance_ || epoch != epoch_)
      *this = {instance, epoch, mark, false};
    else
      is_confirmed_ |= mark != mark_;
    return is_confirmed_;
  }

  /// The epoch that is known goes on: what was said of another was wrong.
  void deny() { *this = {}; }

  EpochConfirmation() = default;

 private:
  EpochConfirmation(std::uint64_t instance, std::uint64_t epoch, std::uint64_t mark, bool is_confirmed)
      : instance_(instance), epoch_(epoch), mark_(mark), is_confirmed_(is_confirmed) {}

  std::uint64_t instance_ = 0;
  std::uint64_t epoch_ = 0;
  std::uint64_t mark_ = 0;
  bool is_confirmed_ = false;
};

}  // namespace rds::service
