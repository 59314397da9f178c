// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/messages/keyframe_conversions.hpp"
#include "common/service/diagnostics.hpp"
#include "common/topics/topics.hpp"

namespace rds::service {

/// For the callback of rds/keyframe/poses: false, counted, for a message that nobody can use. Refused there,
/// impossible messages, which may be large, never wait for a worker.
inline bool is_possible(const rds_msgs::msg::KeyFramePoses& message, Diagnostics& diagnostics) {
  const std::string fault = messages::fault_of(message);
  if (!fault.empty()) diagnostics.reject(topics::kKeyframePoses.name, Rejection::kInvalid, fault);
  return fault.empty();
}

}  // namespace rds::service
