// SPDX-License-Identifier: Apache-2.0
#include "common/concurrency/priority.hpp"

#include <cerrno>
#include <charconv>
#include <filesystem>
#include <string>
#include <system_error>

#include <sys/resource.h>

namespace rds::concurrency {
namespace {

/// On Linux a thread has a priority of its own; id 0 is the calling one.
bool give_way(id_t thread, int nice) {
  errno = 0;
  const int present = getpriority(PRIO_PROCESS, thread);
  if (present == -1 && errno != 0) return errno == ESRCH;  // it has just ended
  return nice <= present || setpriority(PRIO_PROCESS, thread, nice) == 0;
}

}  // namespace

bool give_way(int nice) {
  return give_way(id_t{0}, nice);
}

bool give_way_as_process(int nice) {
  bool all = give_way(nice);  // first, for the threads that this one starts
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/task", error)) {
    const std::string name = entry.path().filename().string();
    id_t thread = 0;
    std::from_chars(name.data(), name.data() + name.size(), thread);
    all = thread != 0 && give_way(thread, nice) && all;
  }
  return all && !error;
}

}  // namespace rds::concurrency
