// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/cli/interrupt.hpp"

#include <csignal>

#include <pthread.h>
#include <unistd.h>

#include "common/service/process/stop_signals.hpp"

namespace rds {
namespace {

constexpr int kKilledBy = 128;  // exit status of a process that a signal has ended, without the signal's number
constexpr timespec kPollInterval{.tv_sec = 0, .tv_nsec = 100'000'000};

}  // namespace

Interrupt::Interrupt() {
  const sigset_t signals = service::stop_signals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  waiter_ = std::jthread([this, signals](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      const int received = sigtimedwait(&signals, nullptr, &kPollInterval);
      if (received <= 0) continue;
      if (source_.stop_requested()) _exit(kKilledBy + received);
      source_.request_stop();
    }
  });
}

Interrupt::~Interrupt() {
  waiter_.request_stop();
  waiter_.join();
  const sigset_t signals = service::stop_signals();
  pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
}

}  // namespace rds
