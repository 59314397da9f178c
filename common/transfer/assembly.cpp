// SPDX-License-Identifier: Apache-2.0
#include "common/transfer/assembly.hpp"

#include <algorithm>

namespace rds::transfer {

std::optional<std::uint32_t> Assembly::next() const {
  if (!again_.empty()) return *again_.begin();
  const std::uint32_t end = size_ > 0 ? chunks_in(size_) : first_chunks_;
  return next_ < end ? std::optional(next_) : std::nullopt;
}

bool Assembly::ask(std::uint32_t index) {
  next_ = std::max(next_, index + 1);
  return again_.erase(index) > 0;
}

Assembly::Verdict Assembly::take(const Chunk& chunk) {
  const std::uint32_t chunks = chunks_in(chunk.item_bytes);
  if ((size_ > 0 && chunk.item_bytes != size_) || chunk.item_bytes > kMaxItemBytes)
    return Verdict::kImpossible;
  if (chunk.index >= chunks || chunk.index >= next_) return Verdict::kImpossible;  // nobody asked for it
  const std::size_t begin = chunk.index * kChunkBytes;
  if (chunk.data.size() != std::min(kChunkBytes, chunk.item_bytes - begin)) return Verdict::kImpossible;
  if (chunk.index < here_.size() && here_[chunk.index]) return Verdict::kRepeated;
  if (size_ == 0) again_.erase(again_.lower_bound(chunks), again_.end());
  size_ = chunk.item_bytes;
  here_.resize(std::max<std::size_t>(here_.size(), chunk.index + 1));
  bytes_.resize(std::max(bytes_.size(), begin + chunk.data.size()));
  here_[chunk.index] = true;
  std::ranges::copy(chunk.data, bytes_.begin() + static_cast<std::ptrdiff_t>(begin));
  again_.erase(chunk.index);
  ++arrived_;
  return Verdict::kTaken;
}

}  // namespace rds::transfer
