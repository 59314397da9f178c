// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <thread>

#include "common/concurrency/mailbox.hpp"
#include "common/concurrency/priority.hpp"
#include "services/tracker/core/mapping/local_mapping.hpp"

namespace rds::tracker {

/// Runs local mapping jobs on a thread of its own, one at a time.
class MappingWorker {
 public:
  /// @param nice     by how much the thread gives way to others.
  /// @param results  gets the result of every job.
  MappingWorker(int nice, concurrency::Inbox<LocalMappingResult>& results)
      : nice_(nice),
        results_(results),
        jobs_(mailbox_, 1),
        thread_([this](const std::stop_token& s) { run(s); }) {}

  void start(LocalMappingJob job) { jobs_.push(std::move(job)); }

 private:
  void run(const std::stop_token& stop) {
    concurrency::give_way(nice_);
    while (mailbox_.wait(stop, [this] { return !jobs_.locked_empty(); }))
      if (const auto job = jobs_.try_pop()) results_.push(run_local_mapping(*job));
  }

  int nice_;
  concurrency::Inbox<LocalMappingResult>& results_;
  concurrency::Mailbox mailbox_;
  concurrency::Inbox<LocalMappingJob> jobs_;
  std::jthread thread_;  // last: it uses the members above
};

}  // namespace rds::tracker
