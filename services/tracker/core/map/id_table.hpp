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
/// on addresses or hashes. Memory comes in blocks of kBlock ids; a block without objects is freed. A block is
/// touched when an object in it is made, erased, or found by somebody who could change it.
template <class T>
class IdTable {
 public:
  using Id = std::uint64_t;
  static constexpr std::size_t kBlock = 128;

  IdTable() = default;
  IdTable(const IdTable& other) : touched_(other.touched_), next_(other.next_), size_(other.size_) {
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
    skip_to(next_ + 1);
    return next_ - 1;
  }
  /// Uses up all ids below this one.
  void skip_to(Id next) {
    if (next <= next_) return;
    next_ = next;
    blocks_.resize((next + kBlock - 1) / kBlock);
    touched_.resize(blocks_.size());
  }

  T& emplace(T object) {
    const Id id = skip_id();
    auto& block = blocks_[id / kBlock];
    if (!block) block = std::make_unique<Block>();
    ++block->used;
    ++size_;
    touched_[id / kBlock] = 1;
    return block->objects[id % kBlock].emplace(std::move(object));
  }

  /// For who will change the object: several threads at a time may only look at a const table.
  [[nodiscard]] T* find(Id id) {
    T* object = look_up(id);
    if (object != nullptr) touched_[id / kBlock] = 1;
    return object;
  }
  [[nodiscard]] const T* find(Id id) const { return look_up(id); }

  void erase(Id id) {
    if (find(id) == nullptr) return;
    auto& block = blocks_[id / kBlock];
    block->objects[id % kBlock].reset();
    --size_;
    if (--block->used == 0) block.reset();
  }

  /// Visits all objects from an id on, by ascending id. Objects may be erased only by the end of it.
  template <class Visit>
  void for_each(Visit visit, Id first = 0) {
    for (std::size_t b = first / kBlock; b < blocks_.size(); ++b) {
      if (!blocks_[b]) continue;
      touched_[b] = 1;
      visit_block(b, first, visit);
    }
  }
  template <class Visit>
  void for_each(Visit visit, Id first = 0) const {
    const auto look = [&](const T& object) { visit(object); };
    for (std::size_t b = first / kBlock; b < blocks_.size(); ++b) visit_block(b, first, look);
  }
  /// Visits the objects of one block, those with ids from kBlock · block on, by ascending id.
  template <class Visit>
  void for_each_in(std::size_t block, Visit visit) const {
    const auto look = [&](const T& object) { visit(object); };
    if (block < blocks_.size()) visit_block(block, 0, look);
  }

  /// The blocks that were touched since the last call, ascending.
  std::vector<std::size_t> take_touched() {
    std::vector<std::size_t> blocks;
    for (std::size_t b = 0; b < touched_.size(); ++b)
      if (std::exchange(touched_[b], std::uint8_t{0}) != 0) blocks.push_back(b);
    return blocks;
  }

 private:
  struct Block {
    std::array<std::optional<T>, kBlock> objects;
    std::size_t used = 0;
  };

  [[nodiscard]] T* look_up(Id id) const {
    if (id >= next_ || !blocks_[id / kBlock]) return nullptr;
    auto& object = blocks_[id / kBlock]->objects[id % kBlock];
    return object ? &*object : nullptr;
  }
  template <class Visit>
  void visit_block(std::size_t b, Id first, const Visit& visit) const {
    if (!blocks_[b]) return;
    for (std::size_t i = first > b * kBlock ? first - b * kBlock : 0; i < kBlock; ++i)
      if (auto& object = blocks_[b]->objects[i]) visit(*object);
  }

  std::vector<std::unique_ptr<Block>> blocks_;
  std::vector<std::uint8_t> touched_;  // per block
  Id next_ = 0;
  std::size_t size_ = 0;
};

}  // namespace rds::tracker
