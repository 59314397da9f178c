// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/keyframe_store.hpp"

#include "services/mapper/core/keyframe_bytes.hpp"

namespace rds::mapper {
namespace {

/// FNV-1a, 64 bit.
std::uint64_t checksum_of(std::span<const std::uint8_t> bytes) {
  std::uint64_t sum = 0xCBF29CE484222325U;
  for (const std::uint8_t byte : bytes) sum = (sum ^ byte) * 0x100000001B3U;
  return sum;
}

}  // namespace

void KeyframeStore::put(const KeyframeRecord& record) {
  erase(record.id);
  auto bytes = to_bytes(record);
  bytes_in_memory_ += bytes.size();
  in_memory_.emplace(record.id, std::move(bytes));
}

std::optional<map_file::Bytes> KeyframeStore::read(const Place& place) const {
  map_file::Bytes bytes(place.size);
  if (!storage_->read(place.offset, bytes) || checksum_of(bytes) != place.checksum) return std::nullopt;
  return bytes;
}

std::optional<KeyframeRecord> KeyframeStore::get(std::uint64_t id) const {
  const auto unpacked = [](std::span<const std::uint8_t> bytes) -> std::optional<KeyframeRecord> {
    auto record = record_from_bytes(bytes);
    return record ? std::optional(std::move(*record)) : std::nullopt;
  };
  if (const auto here = in_memory_.find(id); here != in_memory_.end()) return unpacked(here->second);
  const auto away = spilled_.find(id);
  if (away == spilled_.end()) return std::nullopt;
  const auto bytes = read(away->second);
  return bytes ? unpacked(*bytes) : std::nullopt;
}

void KeyframeStore::erase(std::uint64_t id) {
  if (const auto here = in_memory_.find(id); here != in_memory_.end()) {
    bytes_in_memory_ -= here->second.size();
    in_memory_.erase(here);
  }
  spilled_.erase(id);
}

void KeyframeStore::clear() {
  in_memory_.clear();
  spilled_.clear();
  bytes_in_memory_ = 0;
  if (storage_) storage_->clear();
}

bool KeyframeStore::spill_oldest() {
  if (!storage_) return false;
  const auto oldest = in_memory_.begin();
  const auto& bytes = oldest->second;
  const auto offset = storage_->append(bytes);
  if (!offset) return false;
  spilled_[oldest->first] = {*offset, bytes.size(), checksum_of(bytes)};
  bytes_in_memory_ -= bytes.size();
  in_memory_.erase(oldest);
  return true;
}

}  // namespace rds::mapper
