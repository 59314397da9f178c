// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace rds::service {

/// What this process has used so far.
struct ProcessUsage {
  double cpu_s = 0;              // user and system time of all threads
  std::uint64_t rss_bytes = 0;   // resident now
  std::uint64_t peak_bytes = 0;  // resident at most
};

ProcessUsage process_usage();

}  // namespace rds::service
