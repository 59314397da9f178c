// SPDX-License-Identifier: Apache-2.0
#include "common/time/continuous_time.hpp"

#include <algorithm>

#include "common/time/stamp_step.hpp"

namespace rds::time {

ContinuousTime::Moment ContinuousTime::at(std::int64_t stamp_ns) const {
  if (!newest_) return {stamp_ns, false};
  const auto [newest_ns, newest_time_ns] = *newest_;
  if (step_between(newest_ns, stamp_ns) == StampStep::kBack) return {newest_time_ns + kUnknownNs, true};
  return {newest_time_ns + std::min(stamp_ns - newest_ns, kLongestNs), false};
}

ContinuousTime::Moment ContinuousTime::go_to(std::int64_t stamp_ns) {
  const Moment moment = at(stamp_ns);
  const bool is_newest = !newest_ || stamp_ns > newest_->stamp_ns || moment.went_back;
  if (is_newest) newest_ = {stamp_ns, moment.time_ns};
  return moment;
}

}  // namespace rds::time
