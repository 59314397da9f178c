// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

namespace rds::mapper {

/// When, and in how many keyframes, something was seen in one place.
struct PlaceSightings {
  std::int64_t first_ns;
  std::int64_t last_ns;
  std::int64_t counted_ns;  // of the keyframe counted last: all pixels of one keyframe come in one go
  std::uint32_t keyframes;

  static PlaceSightings at(std::int64_t stamp_ns) { return {stamp_ns, stamp_ns, stamp_ns, 1}; }

  void add(std::int64_t stamp_ns) {
    first_ns = std::min(first_ns, stamp_ns);
    last_ns = std::max(last_ns, stamp_ns);
    keyframes += stamp_ns == counted_ns ? 0 : 1;
    counted_ns = stamp_ns;
  }
};

}  // namespace rds::mapper
