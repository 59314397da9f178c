// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "common/transfer/transfer.hpp"

namespace rds::transfer {

/// The items that a writer keeps for its readers, within a bound.
class ItemStore {
 public:
  using Bytes = std::vector<std::uint8_t>;

  /// @param memory_bytes  of items; beyond, the oldest of the stream that has most are forgotten.
  explicit ItemStore(std::size_t memory_bytes) : memory_bytes_(memory_bytes) {}

  /// One that is empty or larger than kMaxItemBytes is not kept.
  void put(Stream stream, std::uint64_t number, Bytes item);
  /// nullptr: it is not there.
  [[nodiscard]] const Bytes* find(Stream stream, std::uint64_t number) const;
  [[nodiscard]] std::map<Stream, Offer> offers() const;
  void clear() {
    items_.clear();
    bytes_ = 0;
  }

 private:
  void forget_oldest();

  std::size_t memory_bytes_;
  std::map<std::pair<Stream, std::uint64_t>, Bytes> items_;
  std::size_t bytes_ = 0;
};

}  // namespace rds::transfer
