// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "common/transfer/transfer.hpp"

namespace rds::transfer {

/// By when items should be here: kLate after they were offered, longer than a link takes that carries them
/// all.
class Deadlines {
 public:
  static constexpr Time kLate = std::chrono::milliseconds(1500);

  /// All up to this number are offered.
  void note(std::uint64_t newest, Time now) {
    while (offers_.size() > 1 && offers_[1].at + kLate <= now) offers_.pop_front();
    if (offers_.empty() || newest > offers_.back().newest) offers_.push_back({now, newest});
  }
  /// Number up to which all should be here.
  [[nodiscard]] std::optional<std::uint64_t> passed(Time now) const {
    std::optional<std::uint64_t> newest;
    for (const Offered& offered : offers_)
      if (offered.at + kLate <= now) newest = offered.newest;
    return newest;
  }
  /// When the next items should be here.
  [[nodiscard]] std::optional<Time> next(Time now) const {
    for (const Offered& offered : offers_)
      if (offered.at + kLate > now) return offered.at + kLate;
    return std::nullopt;
  }

 private:
  struct Offered {
    Time at{};
    std::uint64_t newest = 0;
  };
  std::deque<Offered> offers_;  // the oldest first; one at most whose deadline had passed at the last offer
};

}  // namespace rds::transfer
