// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/run/services/child_process.hpp"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace rds::run {
namespace {

constexpr int kCannotExecute = 127;

/// In the child, between fork and exec: only async-signal-safe calls.
[[noreturn]] void become(char* const* arguments, int log, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) _exit(kCannotExecute);  // the parent died before the line above
  setpgid(0, 0);  // Ctrl-C reaches the parent only; it stops the children in order
  dup2(log, STDOUT_FILENO);
  dup2(log, STDERR_FILENO);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  execv(arguments[0], arguments);
  _exit(kCannotExecute);
}

ChildExit describe(int status, const rusage& used) {
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_usec) * 1e-6;
  };
  return {WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status),
          seconds(used.ru_utime) + seconds(used.ru_stime), static_cast<std::uint64_t>(used.ru_maxrss) * 1024};
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& command, const std::filesystem::path& log) {
  std::vector<char*> arguments;
  arguments.reserve(command.size() + 1);
  for (const std::string& argument : command) arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  if (access(arguments[0], X_OK) != 0)
    throw std::runtime_error(fmt::format("{}: cannot be executed: {}", command[0], std::strerror(errno)));
  const int log_fd = open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (log_fd < 0)
    throw std::runtime_error(fmt::format("{}: cannot be written: {}", log.string(), std::strerror(errno)));
  const pid_t parent = getpid();
  pid_ = fork();
  if (pid_ == 0) become(arguments.data(), log_fd, parent);
  close(log_fd);
  if (pid_ < 0)
    throw std::runtime_error(fmt::format("{}: cannot be started: {}", command[0], std::strerror(errno)));
}

ChildProcess::~ChildProcess() {
  if (pid_ > 0 && !poll()) {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)), exit_(std::exchange(other.exit_, std::nullopt)) {}

ChildProcess& ChildProcess::operator=(ChildProcess&& other) noexcept {
  std::swap(pid_, other.pid_);
  std::swap(exit_, other.exit_);
  return *this;
}

const std::optional<ChildExit>& ChildProcess::poll() {
  if (exit_ || pid_ <= 0) return exit_;
  int status = 0;
  rusage used{};
  if (wait4(pid_, &status, WNOHANG, &used) == pid_) exit_ = describe(status, used);
  return exit_;
}

void ChildProcess::ask_to_stop() const {
  if (pid_ > 0 && !exit_) kill(pid_, SIGTERM);
}

ChildExit ChildProcess::wait_or_kill(std::chrono::steady_clock::time_point deadline) {
  using namespace std::chrono_literals;
  while (!poll() && std::chrono::steady_clock::now() < deadline) std::this_thread::sleep_for(5ms);
  if (!poll()) {
    kill(pid_, SIGKILL);
    int status = 0;
    rusage used{};
    wait4(pid_, &status, 0, &used);
    exit_ = describe(status, used);
  }
  return *exit_;
}

}  // namespace rds::run
