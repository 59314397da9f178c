// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace rds::tracker {

/// Objects under ids that count up and are never used twice.
///
/// Look-up takes constant time and an unknown id is simply not found; iteration is by id, so nothing depends
/// on addresses or hashes. Memory comes in blocks of kBlock ids; a block without objects is freed.
template <class T>
class IdTable {
 public:
  using Id = std::uint64_t;

  IdTable() = default;
  IdTable(const IdTable& other) : next_(other.next_), size_(other.size_) {
    for (const auto& block : other.blocks_)
      blocks_.push_back(block ? std::make_unique<Block>(*block) : nullptr);
  }
  IdTable(IdTable&&) noexcept = default;
  IdTable& operator=(IdTable&&) noexcept = default;

  /// The id that the next emplace() will give.
  [[nodiscard]] Id next_id() const { return next_; }
  [[nodiscard]] std::size_t size() const { return size_; }

  /// Uses up an id without an object. @return the id.
  Id skip_id() {
    if (next_ / kBlock >= blocks_.size()) blocks_.emplace_back();
    return next_++;
  }

  T& emplace(T object) {
    const Id id = skip_id();
    auto& block = blocks_[id / kBlock];
    if (!block) block = std::make_unique<Block>();
    ++block->used;
    ++size_;
    return block->objects[id % kBlock].emplace(std::move(object));
  }

  [[nodiscard]] T* find(Id id) {
    if (id >= next_ || !blocks_[id / kBlock]) return nullptr;
    auto& object = blocks_[id / kBlock]->objects[id % kBlock];
    return object ? &*object : nullptr;
  }
  [[nodiscard]] const T* find(Id id) const { return const_cast<IdTable*>(this)->find(id); }

  void erase(Id id) {
    if (find(id) == nullptr) return;
    auto& block = blocks_[id / kBlock];
    block->objects[id % kBlock].reset();
    --size_;
    if (--block->used == 0) block.reset();
  }

  /// Visits all objects by ascending id. Objects may be erased only by the end of it.
  template <class Visit>
  void for_each(Visit visit) {
    for (auto& block : blocks_) {
      if (!block) continue;
      for (auto& object : block->objects)
        if (object) visit(*object);
    }
  }
  template <class Visit>
  void for_each(Visit visit) const {
    const_cast<IdTable*>(this)->for_each([&](const T& object) { visit(object); });
  }

 private:
  static constexpr std::size_t kBlock = 128;
  struct Block {
    std::array<std::optional<T>, kBlock> objects;
    std::size_t used = 0;
  };

  std::vector<std::unique_ptr<Block>> blocks_;
  Id next_ = 0;
  std::size_t size_ = 0;
};

}  // namespace rds::tracker
