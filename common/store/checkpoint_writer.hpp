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

namespace rds::store {

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
  /// Told on the writer's thread: a sentence when writing begins to fail, an empty one when it succeeds
  /// again.
  using Report = std::function<void(const std::string& failure)>;
  /// Changes that make a store what the caller has in mind. Called on the writer's thread.
  using Snapshot = std::function<Batch(const Store& written)>;

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

  /// Batches and snapshots.
  [[nodiscard]] std::uint64_t written() const { return written_; }
  [[nodiscard]] std::uint64_t failed() const { return failed_; }

 private:
  void run(const std::stop_token& stop);
  [[nodiscard]] bool has_work() const { return !waiting_.empty() || snapshot_ || copy_asked_; }
  void write_waiting();
  tl::expected<void, std::string> write_now(const Snapshot& snapshot);
  void note(const tl::expected<void, std::string>& result);
  void copy(Clock::time_point deadline);

  Checkpoint checkpoint_;
  Limits limits_;
  Report report_;
  mutable std::mutex store_mutex_;  // of checkpoint_; never taken while mutex_ is held
  mutable std::mutex mutex_;        // of what follows
  std::condition_variable_any changed_;
  Batch waiting_;
  Batch under_way_;  // changed by the writer alone
  Snapshot snapshot_;
  bool copy_asked_ = false;
  bool asked_ = false;  // something is to be tried
  bool is_writing_ = false;
  bool last_failed_ = false;
  bool is_copied_ = false;  // the previous store is as this one
  std::atomic<std::uint64_t> written_ = 0;
  std::atomic<std::uint64_t> failed_ = 0;
  std::jthread thread_;  // last: it uses the members above
};

}  // namespace rds::store
