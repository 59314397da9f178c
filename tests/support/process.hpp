// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <csignal>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

#include "tests/support/temporary_folder.hpp"

namespace rds::test {

/// A child process in a process group of its own; the destructor kills the group and reaps the child.
///
/// stdin is empty; what it prints to stdout and stderr is kept. It dies with the thread that made it.
class Process {
 public:
  using Environment = std::map<std::string, std::string>;

  /// @param arguments  program (looked up in PATH unless it holds a slash) and its arguments.
  /// @param environment  set on top of this process's own. Its folder of maps is its own and goes with it,
  /// unless RDS_MAPS_DIR says otherwise here.
  /// @throws std::runtime_error if no child can be made. A program that cannot be run exits with 127.
  explicit Process(const std::vector<std::string>& arguments, const Environment& environment = {});
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  /// Waits for the exit. @return exit status, 128 + signal for a killed process, nullopt when the time is
  /// over.
  std::optional<int> wait(std::chrono::milliseconds timeout);
  /// Sends a signal to the whole group; nothing happens after the exit.
  void send(int signal);
  void kill() { send(SIGKILL); }

  [[nodiscard]] pid_t pid() const { return pid_; }
  [[nodiscard]] bool running() { return !wait(std::chrono::milliseconds(0)); }
  [[nodiscard]] std::string standard_output() const { return read_text(output_ / "stdout"); }
  [[nodiscard]] std::string standard_error() const { return read_text(output_ / "stderr"); }

  /// Waits until `text` stands in stdout or stderr. @return false when the time is over or the process has
  /// ended.
  bool wait_for_output(const std::string& text, std::chrono::milliseconds timeout);

 private:
  TemporaryFolder output_;
  pid_t pid_ = -1;
  int pid_fd_ = -1;
  std::optional<int> status_;
};

/// Runs to the end. @return exit status (nullopt: killed after the timeout), stdout, stderr.
struct ProcessResult {
  std::optional<int> status;
  std::string standard_output;
  std::string standard_error;
};
ProcessResult run_process(const std::vector<std::string>& arguments, std::chrono::milliseconds timeout,
                          const Process::Environment& environment = {});

}  // namespace rds::test
