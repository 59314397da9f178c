// SPDX-License-Identifier: Apache-2.0
#include "common/store/checkpoint_writer.hpp"

#include <utility>

#include "common/concurrency/priority.hpp"

namespace rds::store {
namespace {
constexpr int kNice = 19;  // nobody waits for a checkpoint
constexpr std::chrono::hours kNoHurry{24};
}  // namespace

CheckpointWriter::CheckpointWriter(Checkpoint checkpoint, Limits limits, Report report)
    : checkpoint_(std::move(checkpoint)),
      limits_(limits),
      log_(std::move(report)),
      is_copied_(checkpoint_.store.rows() == 0),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

CheckpointWriter::~CheckpointWriter() {
  const auto deadline = Clock::now() + limits_.last_words;
  flush(deadline);
  thread_.request_stop();
  thread_.join();
  if (limits_.backup.count() > 0) copy(deadline);
}

/// The thread is to try what waits. @param lock  of mutex_.
void CheckpointWriter::ask(std::unique_lock<std::mutex> lock) {
  asked_ = true;
  lock.unlock();
  changed_.notify_all();
}

bool CheckpointWriter::write(Batch& batch) {
  std::unique_lock lock(mutex_);
  const std::size_t waiting = queue_.bytes();
  const bool fits = waiting == 0 || waiting + batch.bytes() <= limits_.max_waiting_bytes;
  if (fits) queue_.add(std::exchange(batch, {}));
  ask(std::move(lock));
  return fits;
}

void CheckpointWriter::try_again() {
  ask(std::unique_lock(mutex_));
}

void CheckpointWriter::write(Snapshot snapshot) {
  std::unique_lock lock(mutex_);
  queue_.add(std::move(snapshot));
  ask(std::move(lock));
}

void CheckpointWriter::keep_previous() {
  std::unique_lock lock(mutex_);
  copy_asked_ = true;
  ask(std::move(lock));
}

std::optional<Bytes> CheckpointWriter::get(const std::string& kind, std::uint64_t id) const {
  {
    const std::lock_guard lock(mutex_);
    if (const auto* row = queue_.find({kind, id})) return *row;
  }
  const std::lock_guard lock(store_mutex_);
  auto row = checkpoint_.store.get(kind, id);
  return row ? std::move(*row) : std::nullopt;
}

tl::expected<void, std::string> CheckpointWriter::for_each(const std::string& kind,
                                                           const Store::Visit& visit) const {
  const std::lock_guard lock(store_mutex_);
  return checkpoint_.store.for_each(kind, visit);
}

bool CheckpointWriter::flush(Clock::time_point deadline) {
  std::unique_lock lock(mutex_);
  asked_ = true;
  changed_.notify_all();
  const bool in_time = changed_.wait_until(lock, deadline, [this] { return !asked_ && !is_writing_; });
  return in_time && queue_.empty() && !copy_asked_;
}

void CheckpointWriter::run(const std::stop_token& stop) {
  concurrency::give_way(kNice);
  const auto period = limits_.backup.count() > 0 ? limits_.backup : std::chrono::milliseconds(kNoHurry);
  if (limits_.backup.count() > 0) copy(Clock::now() + kNoHurry);  // what was good at the start
  auto copy_due = Clock::now() + period;
  while (!stop.stop_requested()) {
    std::unique_lock lock(mutex_);
    const bool asked = changed_.wait_until(lock, stop, copy_due, [this] { return asked_; });
    const bool copies_now = std::exchange(copy_asked_, false) || (!asked && !stop.stop_requested());
    is_writing_ = true;
    asked_ = false;
    lock.unlock();
    if (copies_now && limits_.backup.count() > 0) {
      copy(Clock::now() + kNoHurry);
      copy_due = Clock::now() + period;
    }
    write_waiting();
    lock.lock();
    is_writing_ = false;
    changed_.notify_all();
  }
}

void CheckpointWriter::write_waiting() {
  {
    const std::lock_guard lock(mutex_);
    if (queue_.empty()) return;
    queue_.begin();
  }
  const auto result = write_now();
  {
    const std::lock_guard lock(mutex_);
    queue_.end(result.has_value());
  }
  if (result) is_copied_ = false;
  log_.note(result);
}

tl::expected<void, std::string> CheckpointWriter::write_now() {
  const std::lock_guard lock(store_mutex_);
  if (!queue_.batch().empty())
    if (auto done = checkpoint_.store.apply(queue_.batch()); !done) return done;
  const Snapshot& snapshot = queue_.snapshot();
  return snapshot ? checkpoint_.store.apply(snapshot(checkpoint_.store)) : tl::expected<void, std::string>();
}

void CheckpointWriter::copy(Clock::time_point deadline) {
  if (is_copied_) return;
  std::unique_lock lock(store_mutex_);
  const auto copied = checkpoint_.keep_previous([&] {
    lock.unlock();  // who reads a row need not wait for the whole copy
    std::this_thread::yield();
    lock.lock();
    return Clock::now() < deadline;
  });
  is_copied_ = copied.has_value();
}

}  // namespace rds::store
