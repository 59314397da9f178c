// SPDX-License-Identifier: Apache-2.0
#include "common/transfer/item_store.hpp"

#include <algorithm>

namespace rds::transfer {

void ItemStore::put(Stream stream, std::uint64_t number, Bytes item) {
  if (item.empty() || item.size() > kMaxItemBytes) return;
  Bytes& kept = items_[{stream, number}];
  bytes_ += item.size() - kept.size();
  kept = std::move(item);
  while (bytes_ > memory_bytes_ && items_.size() > 1) forget_oldest();
}

const ItemStore::Bytes* ItemStore::find(Stream stream, std::uint64_t number) const {
  const auto item = items_.find({stream, number});
  return item == items_.end() ? nullptr : &item->second;
}

std::map<Stream, Offer> ItemStore::offers() const {
  std::map<Stream, Offer> offers;
  for (const auto& [id, item] : items_)
    offers.try_emplace(id.first, Offer{id.second, 0}).first->second.newest = id.second;
  return offers;
}

/// Of the stream that takes most memory.
void ItemStore::forget_oldest() {
  std::map<Stream, std::size_t> sizes;
  for (const auto& [id, item] : items_) sizes[id.first] += item.size();
  const auto most = std::ranges::max_element(sizes, {}, [](const auto& entry) { return entry.second; });
  const auto oldest = items_.lower_bound({most->first, 0});
  bytes_ -= oldest->second.size();
  items_.erase(oldest);
}

}  // namespace rds::transfer
