// SPDX-License-Identifier: Apache-2.0
#include "common/time/stamp_watch.hpp"

namespace rds::time {

StampVerdict StampWatch::take(std::int64_t stamp_ns) {
  const StampStep step = newest_ns_ ? step_between(*newest_ns_, stamp_ns) : StampStep::kOn;
  if (step == StampStep::kAhead || step == StampStep::kBack)
    return doubts_ ? doubt(stamp_ns) : break_at(stamp_ns);
  doubted_ns_.reset();
  if (step == StampStep::kLate) return StampVerdict::kLate;
  newest_ns_ = stamp_ns;
  return step == StampStep::kGap ? StampVerdict::kGap : StampVerdict::kOn;
}

/// One more that is not of the old time: does it go on from the doubted one?
StampVerdict StampWatch::doubt(std::int64_t stamp_ns) {
  const StampStep step = doubted_ns_ ? step_between(*doubted_ns_, stamp_ns) : StampStep::kBack;
  if (step == StampStep::kLate) return StampVerdict::kLate;
  if (step != StampStep::kBack) return break_at(stamp_ns);
  doubted_ns_ = stamp_ns;
  return StampVerdict::kDoubt;
}

StampVerdict StampWatch::break_at(std::int64_t stamp_ns) {
  break_ns_ = stamp_ns - *newest_ns_;
  newest_ns_ = stamp_ns;
  doubted_ns_.reset();
  return StampVerdict::kBreak;
}

}  // namespace rds::time
