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
  return file_.put(kind_of(stream), number, item);
}

std::optional<ItemSpill::Bytes> ItemFile::get(Stream stream, std::uint64_t number) {
  return file_.get(kind_of(stream), number);
}

void ItemFile::erase(Stream stream, std::uint64_t number) {
  file_.erase(kind_of(stream), number);
}

}  // namespace rds::transfer
