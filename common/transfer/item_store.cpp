// SPDX-License-Identifier: Apache-2.0
#include "common/transfer/item_store.hpp"

#include <algorithm>

namespace rds::transfer {
namespace {

constexpr std::size_t kMostReadBack = 8;  // items: more than readers have under way

std::size_t size_of(const ItemSpill::Bytes& item) {
  return item.size();
}
std::size_t size_of(std::size_t bytes) {
  return bytes;
}

}  // namespace

template <class Item>
std::optional<ItemStore::Id> ItemStore::Shelf<Item>::too_much() const {
  if (bytes <= limit_bytes || items.size() < 2) return std::nullopt;
  std::map<Stream, std::size_t> sizes;
  for (const auto& [id, item] : items) sizes[id.first] += size_of(item);
  const auto most = std::ranges::max_element(sizes, {}, [](const auto& entry) { return entry.second; });
  return items.lower_bound({most->first, 0})->first;
}

void ItemStore::put(Stream stream, std::uint64_t number, Bytes item) {
  if (item.empty() || item.size() > kMaxItemBytes) return;
  const Id id{stream, number};
  forget_spilled(id);
  Bytes& kept = memory_.items[id];
  memory_.bytes += item.size() - kept.size();
  kept = std::move(item);
  while (const auto oldest = memory_.too_much()) spill(*oldest);
}

/// Out of memory; into the spill if there is one that takes it.
void ItemStore::spill(const Id& id) {
  const auto item = memory_.items.extract(id);
  const std::size_t bytes = item.mapped().size();
  memory_.bytes -= bytes;
  if (!spill_ || !spill_->put(id.first, id.second, item.mapped())) return;
  spilled_.items[id] = bytes;
  spilled_.bytes += bytes;
  while (const auto oldest = spilled_.too_much()) forget_spilled(*oldest);
}

void ItemStore::forget_spilled(const Id& id) {
  const auto item = spilled_.items.extract(id);
  if (item.empty()) return;
  spilled_.bytes -= item.mapped();
  spill_->erase(id.first, id.second);
  std::erase_if(read_back_, [&](const auto& entry) { return entry.first == id; });
}

const ItemStore::Bytes* ItemStore::find(Stream stream, std::uint64_t number) {
  const Id id{stream, number};
  if (const auto item = memory_.items.find(id); item != memory_.items.end()) return &item->second;
  if (!spilled_.items.contains(id)) return nullptr;
  const auto known = std::ranges::find(read_back_, id, &std::pair<Id, Bytes>::first);
  if (known != read_back_.end()) return &known->second;
  auto item = spill_->get(stream, number);
  if (!item) {
    forget_spilled(id);
    return nullptr;
  }
  if (read_back_.size() >= kMostReadBack) read_back_.pop_front();
  return &read_back_.emplace_back(id, std::move(*item)).second;
}

std::map<Stream, Offer> ItemStore::offers() const {
  std::map<Stream, Offer> offers;
  const auto add = [&](const Id& id) {
    Offer& offer = offers.try_emplace(id.first, Offer{id.second, id.second}).first->second;
    offer.oldest = std::min(offer.oldest, id.second);
    offer.newest = std::max(offer.newest, id.second);
  };
  for (const auto& [id, bytes] : spilled_.items) add(id);
  for (const auto& [id, item] : memory_.items) add(id);
  return offers;
}

void ItemStore::clear() {
  memory_.items.clear();
  memory_.bytes = 0;
  spilled_.items.clear();
  spilled_.bytes = 0;
  read_back_.clear();
  if (spill_) spill_->clear();
}

}  // namespace rds::transfer
