// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/keyframe/keyframe_store.hpp"

#include <algorithm>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "services/mapper/core/keyframe/keyframe_bytes.hpp"

namespace rds::mapper {
namespace {

/// Of a record's bytes, while this process lives.
std::uint64_t checksum_of(std::span<const std::uint8_t> bytes) {
  return XXH3_64bits(bytes.data(), bytes.size());
}

std::optional<KeyframeRecord> unpacked(std::span<const std::uint8_t> bytes) {
  auto record = record_from_bytes(bytes);
  return record ? std::optional(std::move(*record)) : std::nullopt;
}

}  // namespace

void KeyframeStore::put(const KeyframeRecord& record) {
  if (stored_.erase(record.id) > 0) outdated_.insert(record.id);
  auto& bytes = in_memory_[record.id];
  bytes_in_memory_ -= bytes.size();
  bytes = to_bytes(record);
  bytes_in_memory_ += bytes.size();
}

std::optional<KeyframeRecord> KeyframeStore::get(std::uint64_t id) const {
  if (const auto here = in_memory_.find(id); here != in_memory_.end()) return unpacked(here->second);
  const auto away = stored_.find(id);
  if (away == stored_.end()) return std::nullopt;
  const auto bytes = storage_->get(id);
  return bytes && checksum_of(*bytes) == away->second ? unpacked(*bytes) : std::nullopt;
}

void KeyframeStore::erase(std::uint64_t id) {
  if (const auto here = in_memory_.find(id); here != in_memory_.end()) {
    bytes_in_memory_ -= here->second.size();
    in_memory_.erase(here);
  }
  if (stored_.erase(id) + outdated_.erase(id) > 0) storage_->erase(id);
}

bool KeyframeStore::retire(std::uint64_t id) {
  const auto here = in_memory_.find(id);
  const bool kept = here == in_memory_.end() ? stored_.contains(id) : store(id, here->second);
  if (kept) stored_.erase(id);
  erase(id);
  return kept;
}

void KeyframeStore::clear() {
  in_memory_.clear();
  stored_.clear();
  outdated_.clear();
  bytes_in_memory_ = 0;
  if (storage_) storage_->clear();
}

bool KeyframeStore::store(std::uint64_t id, std::span<const std::uint8_t> bytes) {
  if (stored_.contains(id)) return true;
  if (!storage_ || !storage_->put(id, bytes)) return false;
  stored_[id] = checksum_of(bytes);
  outdated_.erase(id);
  return true;
}

bool KeyframeStore::spill_oldest() {
  const auto oldest = in_memory_.begin();
  if (!store(oldest->first, oldest->second)) return false;
  bytes_in_memory_ -= oldest->second.size();
  in_memory_.erase(oldest);
  return true;
}

bool KeyframeStore::save() {
  return std::ranges::all_of(in_memory_,
                             [this](const auto& entry) { return store(entry.first, entry.second); });
}

std::optional<KeyframeRecord> KeyframeStore::adopt(std::uint64_t id) {
  auto bytes = storage_ ? storage_->get(id) : std::nullopt;
  auto record = bytes ? unpacked(*bytes) : std::nullopt;
  if (!record || record->id != id) return std::nullopt;
  stored_[id] = checksum_of(*bytes);
  bytes_in_memory_ += bytes->size();
  in_memory_[id] = std::move(*bytes);
  return record;
}

}  // namespace rds::mapper
