// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "services/mapper/core/keyframe/voxel_key.hpp"

namespace rds::mapper {

/// A set of a block's cells: bit i % 64 of word i / 64 is cell i.
class BlockMask {
 public:
  static constexpr std::size_t kWords = kBlockCells / 64;

  static BlockMask all() {
    BlockMask mask;
    mask.words_.fill(~std::uint64_t{0});
    return mask;
  }
  [[nodiscard]] bool has(std::size_t cell) const { return (words_[cell / 64] >> (cell % 64) & 1U) != 0; }
  void insert(std::size_t cell) { words_[cell / 64] |= std::uint64_t{1} << (cell % 64); }
  void erase(std::size_t cell) { words_[cell / 64] &= ~(std::uint64_t{1} << (cell % 64)); }
  [[nodiscard]] bool empty() const {
    return std::ranges::all_of(words_, [](auto word) { return word == 0; });
  }
  /// 64 cells.
  [[nodiscard]] std::uint64_t word(std::size_t i) const { return words_[i]; }
  std::uint64_t& word(std::size_t i) { return words_[i]; }
  /// Eight cells from `first` on, a multiple of eight.
  [[nodiscard]] std::uint8_t eight(std::size_t first) const {
    return static_cast<std::uint8_t>(words_[first / 64] >> (first % 64));
  }

  BlockMask& operator|=(const BlockMask& other) {
    for (std::size_t i = 0; i < kWords; ++i) words_[i] |= other.words_[i];
    return *this;
  }
  BlockMask& operator&=(const BlockMask& other) {
    for (std::size_t i = 0; i < kWords; ++i) words_[i] &= other.words_[i];
    return *this;
  }
  friend BlockMask operator|(BlockMask a, const BlockMask& b) { return a |= b; }
  friend BlockMask operator&(BlockMask a, const BlockMask& b) { return a &= b; }
  BlockMask operator~() const {
    BlockMask mask;
    for (std::size_t i = 0; i < kWords; ++i) mask.words_[i] = ~words_[i];
    return mask;
  }
  bool operator==(const BlockMask&) const = default;

  /// Calls visit(cell) for each cell in the set, in order.
  template <class Visit>
  void for_each(Visit visit) const {
    for (std::size_t i = 0; i < kWords; ++i)
      for (std::uint64_t left = words_[i]; left != 0; left &= left - 1)
        visit(64 * i + static_cast<std::size_t>(std::countr_zero(left)));
  }

 private:
  std::array<std::uint64_t, kWords> words_{};
};

}  // namespace rds::mapper
