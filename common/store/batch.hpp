// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "common/map_file/byte_writer.hpp"

namespace rds::store {

using map_file::Bytes;

struct Key {
  std::string kind;
  std::uint64_t id = 0;  // below 2^63

  auto operator<=>(const Key&) const = default;
};

/// Changes of a store that are made together or not at all.
class Batch {
 public:
  /// All that is in the store goes, and all that this batch held.
  void clear();
  void put(std::string kind, std::uint64_t id, Bytes bytes);
  void erase(std::string kind, std::uint64_t id);
  /// These changes, then the later ones.
  void add(Batch&& later);

  [[nodiscard]] bool empty() const { return !clears_ && rows_.empty(); }
  [[nodiscard]] bool clears() const { return clears_; }
  /// By key; without bytes: the row is erased.
  [[nodiscard]] const std::map<Key, std::optional<Bytes>>& rows() const { return rows_; }
  /// What this batch says of a row: its bytes, or nullopt if it is not there; nullptr if it says nothing.
  [[nodiscard]] const std::optional<Bytes>* find(const Key& key) const;
  /// Of all rows.
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

 private:
  void set(Key key, std::optional<Bytes> bytes);

  bool clears_ = false;
  std::map<Key, std::optional<Bytes>> rows_;
  std::size_t bytes_ = 0;
};

}  // namespace rds::store
