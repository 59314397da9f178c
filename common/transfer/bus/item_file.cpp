// SPDX-License-Identifier: Apache-2.0
#include "common/transfer/bus/item_file.hpp"

#include <string>

namespace rds::transfer {
namespace {

std::string kind_of(Stream stream) {
  return std::to_string(static_cast<int>(stream));
}

}  // namespace

bool ItemFile::put(Stream stream, std::uint64_t number, const Bytes& item) {
  if (!file_) {
    auto opened = store::Store::nameless({});
    if (!opened) return false;
    file_ = std::move(*opened);
  }
  store::Batch batch;
  batch.put(kind_of(stream), number, item);
  return file_->apply(batch).has_value();
}

std::optional<ItemSpill::Bytes> ItemFile::get(Stream stream, std::uint64_t number) {
  if (!file_) return std::nullopt;
  auto bytes = file_->get(kind_of(stream), number);
  return bytes ? std::move(*bytes) : std::nullopt;
}

void ItemFile::erase(Stream stream, std::uint64_t number) {
  if (!file_) return;
  store::Batch batch;
  batch.erase(kind_of(stream), number);
  (void)file_->apply(batch);  // where that fails its space is not used again
}

}  // namespace rds::transfer
