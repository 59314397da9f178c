// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/transfer/transfer.hpp"

namespace rds::transfer {

/// How long a reader waits for an offer before it takes what a topic carries: somebody who writes the topic
/// and could have been heard, but offers nothing, is no service (a recording that is played). Where nobody
/// writes there is nothing to take: a subscription would draw raw keyframes from another machine as soon as
/// that is reached.
class Patience {
 public:
  /// Longer than a participant that missed an announcement waits for the next one (3 s), and an offer (1 s).
  static constexpr Time kLong = std::chrono::seconds(5);
  /// Where everything is on this machine: until then a tracker has offered, so that strangers are told from it.
  static constexpr Time kShort = std::chrono::seconds(2);

  bool is_over(bool is_written, Time now, Time least = kLong) {
    if (!is_written) since_.reset();
    if (is_written && !since_) since_ = now;
    return since_ && now - *since_ >= least;
  }

 private:
  std::optional<Time> since_;  // it is written
};

}  // namespace rds::transfer
