// SPDX-License-Identifier: Apache-2.0
#include "common/store/batch.hpp"

namespace rds::store {
namespace {

const std::optional<Bytes> kNotThere;

std::size_t size_of(const std::optional<Bytes>& bytes) {
  return bytes ? bytes->size() : 0;
}

}  // namespace

void Batch::clear() {
  clears_ = true;
  rows_.clear();
  bytes_ = 0;
}

void Batch::put(std::string kind, std::uint64_t id, Bytes bytes) {
  set({std::move(kind), id}, std::move(bytes));
}

void Batch::erase(std::string kind, std::uint64_t id) {
  set({std::move(kind), id}, std::nullopt);
}

void Batch::set(Key key, std::optional<Bytes> bytes) {
  auto& row = rows_[std::move(key)];
  bytes_ += size_of(bytes);
  bytes_ -= size_of(row);
  row = std::move(bytes);
}

void Batch::add(Batch&& later) {
  if (later.clears_) {
    *this = std::move(later);
    return;
  }
  while (!later.rows_.empty()) {
    auto row = later.rows_.extract(later.rows_.begin());
    set(std::move(row.key()), std::move(row.mapped()));
  }
  later.bytes_ = 0;
}

const std::optional<Bytes>* Batch::find(const Key& key) const {
  const auto row = rows_.find(key);
  if (row != rows_.end()) return &row->second;
  return clears_ ? &kNotThere : nullptr;
}

}  // namespace rds::store
