// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace rds::run {

/// How a child ended, and what it used.
struct ChildExit {
  int status = 0;  // exit status; 128 + signal if a signal ended it
  double cpu_s = 0;
  std::uint64_t peak_bytes = 0;
};

/// A process of ours with its standard error in a file. It dies with us, and the destructor leaves nothing
/// behind.
class ChildProcess {
 public:
  /// @param command  executable and arguments. @param log  appended to.
  /// @throws std::runtime_error if it cannot be started.
  ChildProcess(const std::vector<std::string>& command, const std::filesystem::path& log);
  ~ChildProcess();
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&& other) noexcept;

  /// How it ended, if it has.
  const std::optional<ChildExit>& poll();

  /// Asks it to stop (SIGTERM); does not wait.
  void ask_to_stop() const;

  /// Waits until `deadline`, then kills it. @return how it ended.
  ChildExit wait_or_kill(std::chrono::steady_clock::time_point deadline);

  [[nodiscard]] pid_t pid() const { return pid_; }

 private:
  pid_t pid_ = -1;
  std::optional<ChildExit> exit_;
};

}  // namespace rds::run
