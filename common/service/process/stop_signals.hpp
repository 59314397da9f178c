// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <csignal>

namespace rds::service {

/// The signals that ask a process to stop: SIGINT and SIGTERM.
inline sigset_t stop_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  return signals;
}

}  // namespace rds::service
