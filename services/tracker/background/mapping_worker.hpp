// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <stop_token>
#include <thread>
#include <utility>

#include "common/concurrency/mailbox.hpp"
#include "common/concurrency/priority.hpp"
#include "services/tracker/core/mapping/global_adjustment.hpp"
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

/// Adjusts the whole map on a thread of its own, which gives way to all others. A new job stops the one
/// before.
class AdjustmentWorker {
 public:
  /// @param results  gets the result of every job that was not stopped.
  explicit AdjustmentWorker(concurrency::Inbox<LocalMappingResult>& results)
      : results_(results), jobs_(mailbox_, 1), thread_([this](const std::stop_token& s) { run(s); }) {}
  ~AdjustmentWorker() { stop(); }

  void start(LocalMappingJob job) {
    stop();
    running_ = std::stop_source();
    jobs_.push({std::move(job), running_.get_token()});
  }
  void stop() { running_.request_stop(); }

 private:
  struct Job {
    LocalMappingJob job;
    std::stop_token stop;
  };
  void run(const std::stop_token& stop) {
    concurrency::give_way(kNice);
    while (mailbox_.wait(stop, [this] { return !jobs_.locked_empty(); }))
      if (const auto next = jobs_.try_pop())
        if (auto result = run_global_adjustment(next->job, next->stop)) results_.push(std::move(*result));
  }

  static constexpr int kNice = 19;

  concurrency::Inbox<LocalMappingResult>& results_;
  std::stop_source running_;  // of the newest job
  concurrency::Mailbox mailbox_;
  concurrency::Inbox<Job> jobs_;
  std::jthread thread_;  // last: it uses the members above
};

}  // namespace rds::tracker
