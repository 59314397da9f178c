// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <mutex>
#include <utility>

#include "common/service/service.hpp"

namespace rds::service {

/// Of the worker, for reports.
struct WorkerState {
  bool there = false;   // stand-by has none
  double silent_s = 0;  // since it last said that it is alive
};

enum class Posted { kQueued, kBusy, kNobody };

/// The service of a process, while it is the active one. Safe to use from any thread.
class ServiceSlot {
 public:
  /// @return the one that was there before.
  std::unique_ptr<Service> put(std::unique_ptr<Service> service) {
    const std::lock_guard lock(mutex_);
    return std::exchange(service_, std::move(service));
  }

  Posted post(PendingCommand command) {
    const std::lock_guard lock(mutex_);
    if (!service_) return Posted::kNobody;
    return service_->post(std::move(command)) ? Posted::kQueued : Posted::kBusy;
  }

  /// As post(), but what nobody takes is answered at once.
  void command(PendingCommand command) {
    const auto answer = command.answer;
    const Posted posted = post(std::move(command));
    if (posted == Posted::kBusy) answer({false, "busy: too many commands wait"});
    if (posted == Posted::kNobody) answer({false, "waits as stand-by, another is active"});
  }

  [[nodiscard]] WorkerState worker_state() const {
    const std::lock_guard lock(mutex_);
    if (!service_) return {};
    return {true, std::chrono::duration<double>(service_->silent_for()).count()};
  }

 private:
  mutable std::mutex mutex_;
  std::unique_ptr<Service> service_;
};

}  // namespace rds::service
