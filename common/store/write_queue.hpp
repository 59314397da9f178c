// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <utility>

#include "common/store/store.hpp"

namespace rds::store {

/// What waits to be written: batches, as one, and the newest snapshot. What is under way comes back if it
/// fails. Not thread-safe.
class WriteQueue {
 public:
  /// Changes that make a store what the caller has in mind.
  using Snapshot = std::function<Batch(const Store& written)>;

  void add(Batch batch) { waiting_.batch.add(std::move(batch)); }
  /// A snapshot that waits is replaced.
  void add(Snapshot snapshot) { waiting_.snapshot = std::move(snapshot); }

  [[nodiscard]] bool empty() const { return waiting_.batch.empty() && !waiting_.snapshot; }
  /// Of the batches, under way or not.
  [[nodiscard]] std::size_t bytes() const { return waiting_.batch.bytes() + under_way_.batch.bytes(); }
  /// What the batches say of a row, as Batch::find().
  [[nodiscard]] const std::optional<Bytes>* find(const Key& key) const {
    const auto* row = waiting_.batch.find(key);
    return row != nullptr ? row : under_way_.batch.find(key);
  }

  /// All that waits is under way from now on.
  void begin() { under_way_ = std::exchange(waiting_, {}); }
  [[nodiscard]] const Batch& batch() const { return under_way_.batch; }
  [[nodiscard]] const Snapshot& snapshot() const { return under_way_.snapshot; }
  /// What was under way is written, or waits again, before what has come since.
  void end(bool written) {
    Changes done = std::exchange(under_way_, {});
    if (written) return;
    done.batch.add(std::move(waiting_.batch));
    waiting_.batch = std::move(done.batch);
    if (!waiting_.snapshot) waiting_.snapshot = std::move(done.snapshot);
  }

 private:
  struct Changes {
    Batch batch;
    Snapshot snapshot;
  };
  Changes waiting_;
  Changes under_way_;
};

}  // namespace rds::store
