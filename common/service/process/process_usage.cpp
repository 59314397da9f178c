// SPDX-License-Identifier: Apache-2.0
#include "common/service/process/process_usage.hpp"

#include <fstream>

#include <sys/resource.h>
#include <unistd.h>

namespace rds::service {

ProcessUsage process_usage() {
  ProcessUsage usage;
  rusage self{};
  if (getrusage(RUSAGE_SELF, &self) == 0) {
    const auto seconds = [](const timeval& t) {
      return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_usec) * 1e-6;
    };
    usage.cpu_s = seconds(self.ru_utime) + seconds(self.ru_stime);
    usage.peak_bytes = static_cast<std::uint64_t>(self.ru_maxrss) * 1024;
  }
  std::ifstream statm("/proc/self/statm");
  std::uint64_t total_pages = 0;
  std::uint64_t resident_pages = 0;
  if (statm >> total_pages >> resident_pages)
    usage.rss_bytes = resident_pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
  return usage;
}

}  // namespace rds::service
