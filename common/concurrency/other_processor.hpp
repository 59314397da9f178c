// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pthread.h>
#include <sched.h>

namespace rds::concurrency {

/// Keeps a thread off the processor of the thread that wakes it.
///
/// Where all processors are busy, schedulers wake a thread on the waker's own, where it cannot begin before
/// the waker sleeps: of no help to a thread that wants to be helped at once. Needs no privileges; where the
/// system does not allow it, or has one processor only, nothing changes.
class OtherProcessor {
 public:
  /// @param thread  has to outlive this; where it may run now is where it may run later.
  explicit OtherProcessor(pthread_t thread);

  /// Called by the thread that is about to wake the other; cheap as long as it stays on its processor.
  void keep_off_mine();

 private:
  pthread_t thread_;
  cpu_set_t allowed_{};
  int kept_off_ = -1;
};

}  // namespace rds::concurrency
