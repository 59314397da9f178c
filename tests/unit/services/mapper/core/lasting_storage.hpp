// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>

#include "services/mapper/core/keyframe/keyframe_store.hpp"

namespace rds::mapper::test {

/// Keyframe records that outlast a mapper.
class LastingStorage : public SpillStorage {
 public:
  using Rows = std::map<std::uint64_t, map_file::Bytes>;
  explicit LastingStorage(Rows& rows) : rows_(rows) {}
  bool put(std::uint64_t id, std::span<const std::uint8_t> bytes) override {
    rows_[id] = {bytes.begin(), bytes.end()};
    return true;
  }
  std::optional<map_file::Bytes> get(std::uint64_t id) override {
    const auto row = rows_.find(id);
    return row == rows_.end() ? std::nullopt : std::optional(row->second);
  }
  void erase(std::uint64_t id) override { rows_.erase(id); }
  void clear() override { rows_.clear(); }

 private:
  Rows& rows_;
};

}  // namespace rds::mapper::test
