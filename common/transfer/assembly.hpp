// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include "common/transfer/transfer.hpp"

namespace rds::transfer {

/// An item as its chunks come in, in any order. Memory grows with what has come, up to the declared size.
class Assembly {
 public:
  static constexpr std::uint32_t kFirstChunks = 16;

  /// @param first_chunks  to ask for before the size is known.
  explicit Assembly(std::uint32_t first_chunks = kFirstChunks) : first_chunks_(first_chunks) {}

  /// The next chunk to ask for; those that were lost come first. @return nothing while all are asked for
  [[nodiscard]] std::optional<std::uint32_t> next() const;
  /// Takes note that it is asked for. @return true if not for the first time
  bool ask(std::uint32_t index);
  /// Takes note that it was lost.
  void lost(std::uint32_t index) { again_.insert(index); }

  enum class Verdict : std::uint8_t { kTaken, kRepeated, kImpossible };
  /// Impossible: of another size than the chunks before, of a wrong length, or never asked for.
  Verdict take(const Chunk& chunk);
  /// 0 until the first chunk has come.
  [[nodiscard]] std::uint32_t size() const { return size_; }
  [[nodiscard]] bool complete() const { return size_ > 0 && arrived_ == chunks_in(size_); }
  [[nodiscard]] std::vector<std::uint8_t>& bytes() { return bytes_; }

 private:
  std::uint32_t first_chunks_;
  std::uint32_t size_ = 0;  // bytes
  std::uint32_t next_ = 0;  // chunk that was never asked for
  std::uint32_t arrived_ = 0;
  std::set<std::uint32_t> again_;
  std::vector<bool> here_;  // by chunk
  std::vector<std::uint8_t> bytes_;
};

}  // namespace rds::transfer
