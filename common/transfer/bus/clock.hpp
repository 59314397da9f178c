// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

#include "common/transfer/transfer.hpp"

namespace rds::transfer {

inline Time now() {
  return std::chrono::steady_clock::now().time_since_epoch();
}

/// Who lacks something for so long is behind: more than a keyframe's way on a link that carries them all.
inline constexpr std::chrono::milliseconds kBehindAfter{1500};

}  // namespace rds::transfer
