// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/bus/qos.hpp"

namespace rds::bus::detail {

/// Whether readers ask again for what they miss. Not for pictures: on a slow link the next one is worth more
/// than the one that was lost.
inline bool recovers(const Qos& qos) {
  return qos.reliable && qos.urgency != Urgency::kPictures;
}

}  // namespace rds::bus::detail
