// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "common/store/generations.hpp"
#include "common/store/write_queue.hpp"

namespace rds::store {

/// Counts what was written and what failed, and tells when the one turns into the other. Written by one thread.
class WriteLog {
 public:
  /// A sentence when writing begins to fail, an empty one when it succeeds again.
  using Report = std::function<void(const std::string& failure)>;

  explicit WriteLog(Report report) : report_(std::move(report)) {}
  void note(const tl::expected<void, std::string>& result) {
    ++(result ? written_ : failed_);
    if (std::exchange(last_failed_, !result) != !result) report_(result ? std::string() : result.error());
  }
  /// Batches and snapshots (any thread).
  [[nodiscard]] std::uint64_t written() const { return written_; }
  [[nodiscard]] std::uint64_t failed() const { return failed_; }

 private:
  Report report_;
  bool last_failed_ = false;
  std::atomic<std::uint64_t> written_ = 0;
  std::atomic<std::uint64_t> failed_ = 0;
};

/// Writes a checkpoint on a thread of its own: who hands changes over waits for no disk.
///
/// What cannot be written (a full disk) stays here and is tried again with what comes next; there is a bound
/// to that. All members may be called by any thread.
class CheckpointWriter {
 public:
  using Clock = std::chrono::steady_clock;
  struct Limits {
    std::size_t max_waiting_bytes = 64'000'000;
    std::chrono::milliseconds backup{600'000};  // between two copies that become the previous store; 0: none
    std::chrono::milliseconds last_words{
        5000};  // what the destructor gives to the last changes, and to a copy
  };
  /// Called on the writer's thread, and so is a snapshot.
  using Report = WriteLog::Report;
  using Snapshot = WriteQueue::Snapshot;

  CheckpointWriter(Checkpoint checkpoint, Limits limits, Report report);
  /// Writes what waits, and makes the present store the previous one, as far as time allows.
  ~CheckpointWriter();
  CheckpointWriter(const CheckpointWriter&) = delete;
  CheckpointWriter& operator=(const CheckpointWriter&) = delete;

  /// Takes changes over; the batch is empty then. One batch is always taken where none waits.
  /// @return false if too much waits: then it is as it was.
  [[nodiscard]] bool write(Batch& batch);
  /// Tries to write what could not be written.
  void try_again();
  /// Takes a snapshot over; one that waits is replaced.
  void write(Snapshot snapshot);
  /// Makes the store as it is now the previous one, before anything more is written.
  void keep_previous();

  /// The bytes of a row as they will be when all batches are written; nullopt if it is not there or cannot be
  /// read.
  [[nodiscard]] std::optional<Bytes> get(const std::string& kind, std::uint64_t id) const;

  /// Visits the rows of a kind that are written, by ascending id. @return or one sentence.
  tl::expected<void, std::string> for_each(const std::string& kind, const Store::Visit& visit) const;

  /// Tries to write all that waits. @return false if that failed, or the time is over.
  bool flush(Clock::time_point deadline);

  [[nodiscard]] const WriteLog& log() const { return log_; }

 private:
  void run(const std::stop_token& stop);
  void ask(std::unique_lock<std::mutex> lock);
  void write_waiting();
  tl::expected<void, std::string> write_now();
  void copy(Clock::time_point deadline);

  Checkpoint checkpoint_;
  Limits limits_;
  WriteLog log_;
  mutable std::mutex store_mutex_;  // of checkpoint_; never taken while mutex_ is held
  mutable std::mutex mutex_;        // of what follows
  std::condition_variable_any changed_;
  WriteQueue queue_;  // what is under way is changed by the writer alone
  bool copy_asked_ = false;
  bool asked_ = false;  // something is to be tried
  bool is_writing_ = false;
  bool is_copied_ = false;  // the previous store is as this one
  std::jthread thread_;  // last: it uses the members above
};

}  // namespace rds::store
