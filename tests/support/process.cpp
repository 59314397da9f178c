// SPDX-License-Identifier: Apache-2.0
#include "tests/support/process.hpp"

#include <algorithm>
#include <cerrno>
#include <stdexcept>

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

namespace rds::test {
namespace {
using Clock = std::chrono::steady_clock;
constexpr int kCannotRun = 127;
constexpr int kSignalBase = 128;
constexpr std::chrono::milliseconds kOutputCheckPeriod{10};

std::vector<std::string> environment_with(const Process::Environment& extra) {
  std::vector<std::string> result;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string text = *entry;
    if (!extra.contains(text.substr(0, text.find('=')))) result.push_back(text);
  }
  for (const auto& [name, value] : extra) result.push_back(name + "=" + value);
  return result;
}

std::vector<char*> pointers(std::vector<std::string>& words) {
  std::vector<char*> result;
  for (auto& word : words) result.push_back(word.data());
  result.push_back(nullptr);
  return result;
}

/// In the child, between fork and exec: only async-signal-safe calls.
[[noreturn]] void become(char* const* arguments, char* const* environment, const char* out, const char* err) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const int in = open("/dev/null", O_RDONLY);
  const int out_fd = open(out, O_WRONLY | O_CREAT | O_APPEND, 0600);
  const int err_fd = open(err, O_WRONLY | O_CREAT | O_APPEND, 0600);
  dup2(in, STDIN_FILENO);
  dup2(out_fd, STDOUT_FILENO);
  dup2(err_fd, STDERR_FILENO);
  execvpe(arguments[0], arguments, environment);
  _exit(kCannotRun);
}
}  // namespace

Process::Process(const std::vector<std::string>& arguments, const Environment& environment) {
  auto words = arguments;
  Environment extra = environment;
  extra.emplace("RDS_MAPS_DIR", (output_ / "maps").string());
  auto variables = environment_with(extra);
  const auto argv = pointers(words);
  const auto envp = pointers(variables);
  const std::string out = (output_ / "stdout").string();
  const std::string err = (output_ / "stderr").string();
  write_text(out, "");
  write_text(err, "");
  pid_ = fork();
  if (pid_ == 0) become(argv.data(), envp.data(), out.c_str(), err.c_str());
  if (pid_ < 0) throw std::runtime_error("fork: no child process for " + arguments.at(0));
  setpgid(pid_, pid_);  // also here, so that the group exists before the first send()
  pid_fd_ = static_cast<int>(syscall(SYS_pidfd_open, pid_, 0));
}

Process::~Process() {
  ::kill(-pid_, SIGKILL);  // what the child left behind in its group as well
  if (!status_) waitpid(pid_, nullptr, 0);
  if (pid_fd_ >= 0) close(pid_fd_);
}

std::optional<int> Process::wait(std::chrono::milliseconds timeout) {
  if (status_) return status_;
  pollfd waiting{.fd = pid_fd_, .events = POLLIN, .revents = 0};
  if (poll(&waiting, 1, static_cast<int>(timeout.count())) <= 0) return std::nullopt;
  int raw = 0;
  if (waitpid(pid_, &raw, 0) != pid_) return std::nullopt;
  status_ = WIFEXITED(raw) ? WEXITSTATUS(raw) : kSignalBase + WTERMSIG(raw);
  return status_;
}

void Process::send(int signal) {
  if (!wait(std::chrono::milliseconds(0))) ::kill(-pid_, signal);
}

bool Process::wait_for_output(const std::string& text, std::chrono::milliseconds timeout) {
  const auto seen = [&] {
    return standard_output().find(text) != std::string::npos ||
           standard_error().find(text) != std::string::npos;
  };
  const auto end = Clock::now() + timeout;
  while (Clock::now() < end) {
    if (seen()) return true;
    if (wait(kOutputCheckPeriod)) return seen();
  }
  return seen();
}

ProcessResult run_process(const std::vector<std::string>& arguments, std::chrono::milliseconds timeout,
                          const Process::Environment& environment) {
  Process process(arguments, environment);
  const auto status = process.wait(timeout);
  if (!status) process.kill();
  return {status, process.standard_output(), process.standard_error()};
}

}  // namespace rds::test
