// SPDX-License-Identifier: Apache-2.0
#include "common/concurrency/parallel_for.hpp"

#include <utility>

namespace rds::concurrency {

ParallelFor::ParallelFor()
    : thread_([this](const std::stop_token& stop) { help(stop); }), processor_(thread_.native_handle()) {}

void ParallelFor::run(std::size_t count, const std::function<void(std::size_t)>& part) {
  {
    const std::lock_guard lock(mutex_);
    part_ = &part;
    count_ = count;
    next_ = 0;
  }
  if (count > 1) {
    processor_.keep_off_mine();
    changed_.notify_all();
  }
  do_parts();
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return begun_ == 0; });
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void ParallelFor::help(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (changed_.wait(lock, stop, [this] { return next_ < count_; })) {
    lock.unlock();
    do_parts();
    lock.lock();
  }
}

void ParallelFor::do_parts() {
  std::unique_lock lock(mutex_);
  while (next_ < count_) {
    const std::size_t i = next_++;
    const auto& part = *part_;
    ++begun_;
    lock.unlock();
    std::exception_ptr failure;
    try {
      part(i);
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    --begun_;
    if (!failure) continue;
    if (!failure_) failure_ = std::move(failure);
    next_ = count_;
  }
  changed_.notify_all();
}

}  // namespace rds::concurrency
