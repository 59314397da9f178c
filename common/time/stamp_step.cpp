// SPDX-License-Identifier: Apache-2.0
#include "common/time/stamp_step.hpp"

namespace rds::time {

StampStep step_between(std::int64_t newest_ns, std::int64_t next_ns) {
  const std::int64_t step_ns = next_ns - newest_ns;
  if (step_ns < -kLateNs) return StampStep::kBack;
  if (step_ns <= 0) return StampStep::kLate;
  if (step_ns <= kGapNs) return StampStep::kOn;
  return step_ns <= kAheadNs ? StampStep::kGap : StampStep::kAhead;
}

}  // namespace rds::time
