// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <set>

#include "common/map_file/byte_writer.hpp"
#include "services/mapper/core/keyframe/keyframe_record.hpp"

namespace rds::mapper {

/// Storage for packed keyframes beyond the limit of memory, or that outlast the process. Implemented outside
/// of the core, which knows no files.
class SpillStorage {
 public:
  SpillStorage() = default;
  SpillStorage(const SpillStorage&) = delete;
  SpillStorage& operator=(const SpillStorage&) = delete;
  virtual ~SpillStorage() = default;
  /// Keeps bytes under an id, instead of those it kept before. @return false if they could not be stored.
  virtual bool put(std::uint64_t id, std::span<const std::uint8_t> bytes) = 0;
  /// @return the bytes; nullopt if they are not there or could not be read.
  virtual std::optional<map_file::Bytes> get(std::uint64_t id) = 0;
  virtual void erase(std::uint64_t id) = 0;
  virtual void clear() = 0;
};

/// Keyframe records by id, packed; in memory, or where they were spilled to.
class KeyframeStore {
 public:
  /// @param storage  may be nullptr: nothing can be spilled.
  explicit KeyframeStore(std::unique_ptr<SpillStorage> storage) : storage_(std::move(storage)) {}

  /// Adds or replaces a record.
  void put(const KeyframeRecord& record);
  /// The record as it was put, without pose and rays; nullopt if it is not there or its bytes came back
  /// wrong.
  [[nodiscard]] std::optional<KeyframeRecord> get(std::uint64_t id) const;
  void erase(std::uint64_t id);
  /// As erase(), but the storage keeps the record as it is now, for erase_retired(). @return false if it
  /// could not be stored: it is erased.
  bool retire(std::uint64_t id);
  /// What the storage kept after retire() goes.
  void erase_retired(std::uint64_t id) { storage_->erase(id); }
  void clear();

  /// Puts into the storage what it does not have as it is now; it stays in memory, too. @return false if some
  /// of it could not be stored.
  bool save();
  /// Takes over what the storage has under an id, from before this object was made. @return the record, as
  /// get().
  std::optional<KeyframeRecord> adopt(std::uint64_t id);

  [[nodiscard]] std::size_t bytes_in_memory() const { return bytes_in_memory_; }
  [[nodiscard]] std::size_t in_memory() const { return in_memory_.size(); }
  /// The oldest record in memory. At least one must be there.
  [[nodiscard]] std::uint64_t oldest_in_memory() const { return in_memory_.begin()->first; }
  /// Moves it to the storage, where that does not have it. @return false if that failed: it stays in memory.
  bool spill_oldest();

 private:
  bool store(std::uint64_t id, std::span<const std::uint8_t> bytes);

  std::unique_ptr<SpillStorage> storage_;
  std::map<std::uint64_t, map_file::Bytes> in_memory_;
  std::map<std::uint64_t, std::uint64_t> stored_;  // checksums of what the storage has as it is now
  std::set<std::uint64_t> outdated_;               // of which it has an older record
  std::size_t bytes_in_memory_ = 0;
};

}  // namespace rds::mapper
