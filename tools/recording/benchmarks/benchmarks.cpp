// SPDX-License-Identifier: Apache-2.0
#include "tools/recording/benchmarks/benchmarks.hpp"

namespace rds::recording {

std::optional<OpenedBenchmark> open_benchmark(const std::filesystem::path& folder) {
  for (const auto open : {open_icl_nuim, open_seven_scenes, open_replica, open_scan_net})
    if (auto opened = open(folder)) return opened;
  return std::nullopt;
}

}  // namespace rds::recording
