// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <thread>

#include "common/concurrency/mailbox.hpp"
#include "services/tracker/core/local_mapping.hpp"

namespace rds::tracker {

/// Runs local mapping jobs on a thread of its own, one at a time.
class MappingWorker {
 public:
  /// @param results  gets the result of every job.
  MappingWorker(const LocalMappingConfig& config, concurrency::Inbox<LocalMappingResult>& results)
      : config_(config),
        results_(results),
        jobs_(mailbox_, 1),
        thread_([this](const std::stop_token& s) { run(s); }) {}

  void start(LocalMappingJob job) { jobs_.push(std::move(job)); }

 private:
  void run(const std::stop_token& stop) {
    while (mailbox_.wait(stop, [this] { return !jobs_.locked_empty(); }))
      if (const auto job = jobs_.try_pop()) results_.push(run_local_mapping(*job, config_));
  }

  LocalMappingConfig config_;
  concurrency::Inbox<LocalMappingResult>& results_;
  concurrency::Mailbox mailbox_;
  concurrency::Inbox<LocalMappingJob> jobs_;
  std::jthread thread_;  // last: it uses the members above
};

}  // namespace rds::tracker
