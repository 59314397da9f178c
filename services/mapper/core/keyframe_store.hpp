// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>

#include "common/map_file/byte_writer.hpp"
#include "services/mapper/core/keyframe_record.hpp"

namespace rds::mapper {

/// Where packed keyframes go that memory shall not hold: a file, for those who know files.
class SpillStorage {
 public:
  SpillStorage() = default;
  SpillStorage(const SpillStorage&) = delete;
  SpillStorage& operator=(const SpillStorage&) = delete;
  virtual ~SpillStorage() = default;
  /// @return where the bytes begin; nullopt if they could not be stored.
  virtual std::optional<std::uint64_t> append(std::span<const std::uint8_t> bytes) = 0;
  /// Fills `bytes` from there. @return false if they could not be read.
  virtual bool read(std::uint64_t offset, std::span<std::uint8_t> bytes) = 0;
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
  void clear();

  [[nodiscard]] std::size_t bytes_in_memory() const { return bytes_in_memory_; }
  [[nodiscard]] std::size_t in_memory() const { return in_memory_.size(); }
  /// The oldest record in memory. At least one must be there.
  [[nodiscard]] std::uint64_t oldest_in_memory() const { return in_memory_.begin()->first; }
  /// Moves it to the storage. @return false if that failed: it stays in memory.
  bool spill_oldest();

 private:
  struct Place {
    std::uint64_t offset;
    std::size_t size;
    std::uint64_t checksum;
  };
  [[nodiscard]] std::optional<map_file::Bytes> read(const Place& place) const;

  std::unique_ptr<SpillStorage> storage_;
  std::map<std::uint64_t, map_file::Bytes> in_memory_;
  std::map<std::uint64_t, Place> spilled_;
  std::size_t bytes_in_memory_ = 0;
};

}  // namespace rds::mapper
