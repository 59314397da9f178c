// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "common/transfer/transfer.hpp"

namespace rds::transfer {

/// When a reader tells its writer how far it is behind, though it has nothing to ask for: each second, and at
/// once where it falls behind or has caught up.
class Hello {
 public:
  /// @param overdue  items that should be here (Receiver).
  bool is_due(std::size_t overdue, Time now) {
    const bool is_behind = overdue > 0;
    if (is_behind == was_behind_ && now - told_at_ < kPeriod) return false;
    was_behind_ = is_behind;
    told_at_ = now;
    return true;
  }

 private:
  static constexpr Time kPeriod = std::chrono::seconds(1);

  bool was_behind_ = false;
  Time told_at_ = -kPeriod;
};

}  // namespace rds::transfer
