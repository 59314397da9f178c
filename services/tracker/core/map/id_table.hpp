// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
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
/// on addresses or hashes. Memory comes in blocks of kBlock ids, and the table of blocks in pages, so that
/// ids which are left out, millions with each restart, cost next to nothing; a block without objects is
/// freed. A block is touched when an object in it is made, erased, or found by somebody who could change it.
template <class T>
class IdTable {
 public:
  using Id = std::uint64_t;
  static constexpr std::size_t kBlock = 128;

  IdTable() = default;
  IdTable(const IdTable& other) : next_(other.next_), size_(other.size_) {
    for (const auto& page : other.pages_) pages_.push_back(page ? std::make_unique<Page>(*page) : nullptr);
  }
  IdTable(IdTable&&) noexcept = default;
  IdTable& operator=(IdTable&&) noexcept = default;

  /// The id that the next emplace() will give.
  [[nodiscard]] Id next_id() const { return next_; }
  [[nodiscard]] std::size_t size() const { return size_; }

  /// Uses up an id without an object. @return the id.
  Id skip_id() { return next_++; }
  /// Uses up all ids below this one.
  void skip_to(Id next) { next_ = std::max(next_, next); }

  T& emplace(T object) {
    const Id id = skip_id();
    Page& page = page_of(id / kBlock);
    auto& block = page.blocks[id / kBlock % kPage];
    if (!block) block = std::make_unique<Block>();
    ++block->used;
    ++size_;
    page.touched[id / kBlock % kPage] = 1;
    return block->objects[id % kBlock].emplace(std::move(object));
  }

  /// For who will change the object: several threads at a time may only look at a const table.
  [[nodiscard]] T* find(Id id) {
    T* object = look_up(id);
    if (object != nullptr) pages_[id / kBlock / kPage]->touched[id / kBlock % kPage] = 1;
    return object;
  }
  [[nodiscard]] const T* find(Id id) const { return look_up(id); }

  void erase(Id id) {
    if (find(id) == nullptr) return;
    auto& block = pages_[id / kBlock / kPage]->blocks[id / kBlock % kPage];
    block->objects[id % kBlock].reset();
    --size_;
    if (--block->used == 0) block.reset();
  }

  /// Visits all objects from an id on, by ascending id. Objects may be erased only by the end of it.
  template <class Visit>
  void for_each(Visit visit, Id first = 0) {
    for_each_page(first / kBlock / kPage, [&](std::size_t p, Page& page) {
      for (std::size_t b = first_block(p, first); b < kPage; ++b) {
        if (!page.blocks[b]) continue;
        page.touched[b] = 1;
        visit_block(*page.blocks[b], p * kPage + b, first, visit);
      }
    });
  }
  template <class Visit>
  void for_each(Visit visit, Id first = 0) const {
    const auto look = [&](const T& object) { visit(object); };
    for_each_page(first / kBlock / kPage, [&](std::size_t p, const Page& page) {
      for (std::size_t b = first_block(p, first); b < kPage; ++b)
        if (page.blocks[b]) visit_block(*page.blocks[b], p * kPage + b, first, look);
    });
  }
  /// Visits the objects of one block, those with ids from kBlock · block on, by ascending id.
  template <class Visit>
  void for_each_in(std::size_t block, Visit visit) const {
    const auto look = [&](const T& object) { visit(object); };
    if (const Block* found = look_up_block(block)) visit_block(*found, block, 0, look);
  }

  /// The blocks that were touched since the last call, ascending.
  std::vector<std::size_t> take_touched() {
    std::vector<std::size_t> blocks;
    for_each_page(0, [&](std::size_t p, Page& page) {
      for (std::size_t b = 0; b < kPage; ++b)
        if (std::exchange(page.touched[b], std::uint8_t{0}) != 0) blocks.push_back(p * kPage + b);
    });
    return blocks;
  }

 private:
  static constexpr std::size_t kPage = 1024;  // blocks: 131072 ids

  struct Block {
    std::array<std::optional<T>, kBlock> objects;
    std::size_t used = 0;
  };
  struct Page {
    Page() = default;
    Page(const Page& other) : touched(other.touched) {
      for (std::size_t b = 0; b < kPage; ++b)
        if (other.blocks[b]) blocks[b] = std::make_unique<Block>(*other.blocks[b]);
    }
    std::array<std::unique_ptr<Block>, kPage> blocks;
    std::array<std::uint8_t, kPage> touched{};  // by block
  };

  Page& page_of(std::size_t block) {
    if (block / kPage >= pages_.size()) pages_.resize(block / kPage + 1);
    auto& page = pages_[block / kPage];
    if (!page) page = std::make_unique<Page>();
    return *page;
  }
  [[nodiscard]] Block* look_up_block(std::size_t block) const {
    const std::size_t page = block / kPage;
    return page < pages_.size() && pages_[page] ? pages_[page]->blocks[block % kPage].get() : nullptr;
  }
  [[nodiscard]] T* look_up(Id id) const {
    Block* block = look_up_block(id / kBlock);
    if (block == nullptr) return nullptr;
    auto& object = block->objects[id % kBlock];
    return object ? &*object : nullptr;
  }
  template <class Visit>
  void for_each_page(std::size_t first, Visit visit) const {
    for (std::size_t p = first; p < pages_.size(); ++p)
      if (pages_[p]) visit(p, *pages_[p]);
  }
  static std::size_t first_block(std::size_t page, Id first) {
    return first / kBlock > page * kPage ? first / kBlock - page * kPage : 0;
  }
  template <class Object, class Visit>
  static void visit_block(Object& block, std::size_t b, Id first, const Visit& visit) {
    for (std::size_t i = first > b * kBlock ? first - b * kBlock : 0; i < kBlock; ++i)
      if (auto& object = block.objects[i]) visit(*object);
  }

  std::vector<std::unique_ptr<Page>> pages_;
  Id next_ = 0;
  std::size_t size_ = 0;
};

}  // namespace rds::tracker
