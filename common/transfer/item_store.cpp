// SPDX-License-Identifier: Apache-2.0
#include "common/transfer/item_store.hpp"

#include <algorithm>
#include <iterator>
#include <limits>

namespace rds::transfer {
namespace {

constexpr std::size_t kMostReadBack = 8;    // items: more than readers have under way
constexpr std::size_t kMostLost = 100'000;  // numbers of a stream that are known one by one

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

template <class Item>
void ItemStore::Shelf<Item>::widen(std::map<Stream, Offer>& offers) const {
  for (auto first = items.begin(); first != items.end();) {
    const Stream stream = first->first.first;
    const auto end = items.upper_bound({stream, std::numeric_limits<std::uint64_t>::max()});
    const std::uint64_t oldest = first->first.second;
    const std::uint64_t newest = std::prev(end)->first.second;
    Offer& offer = offers.try_emplace(stream, Offer{oldest, newest}).first->second;
    offer.oldest = std::min(offer.oldest, oldest);
    offer.newest = std::max(offer.newest, newest);
    first = end;
  }
}

void ItemStore::put(Stream stream, std::uint64_t number, Bytes item) {
  const Id id{stream, number};
  if (item.empty() || item.size() > kMaxItemBytes) return lose(id);
  forget_spilled(id);
  if (const auto lost = lost_.find(stream); lost != lost_.end()) lost->second.numbers.erase(number);
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
  if (!spill_ || !spill_->put(id.first, id.second, item.mapped())) return lose(id);
  spilled_.items[id] = bytes;
  spilled_.bytes += bytes;
  while (const auto oldest = spilled_.too_much()) {
    forget_spilled(*oldest);
    lose(*oldest);
  }
}

void ItemStore::lose(const Id& id) {
  if (memory_.items.contains(id) || spilled_.items.contains(id)) return;
  Lost& lost = lost_[id.first];
  lost.numbers.insert(id.second);
  const auto oldest = this->oldest(id.first);
  while ((oldest && !lost.numbers.empty() && *lost.numbers.begin() < *oldest) ||
         lost.numbers.size() > kMostLost) {
    lost.numbers.erase(lost.numbers.begin());
    ++lost.older;
  }
}

bool ItemStore::is_lost(Stream stream, std::uint64_t number) const {
  const auto lost = lost_.find(stream);
  if (lost == lost_.end()) return false;
  const auto oldest = this->oldest(stream);
  return lost->second.numbers.contains(number) || (lost->second.older > 0 && oldest && number < *oldest);
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
    lose(id);
    return nullptr;
  }
  if (read_back_.size() >= kMostReadBack) read_back_.pop_front();
  return &read_back_.emplace_back(id, std::move(*item)).second;
}

std::map<Stream, Offer> ItemStore::offers() const {
  std::map<Stream, Offer> offers;
  memory_.widen(offers);
  spilled_.widen(offers);
  for (auto& [stream, offer] : offers)
    if (const auto lost = lost_.find(stream); lost != lost_.end()) {
      const auto& numbers = lost->second.numbers;
      const auto older = std::distance(numbers.begin(), numbers.lower_bound(offer.oldest));
      offer.lost = lost->second.older + static_cast<std::uint64_t>(older);
    }
  return offers;
}

std::uint64_t ItemStore::lost(Stream stream) const {
  const auto lost = lost_.find(stream);
  return lost == lost_.end() ? 0 : lost->second.older + lost->second.numbers.size();
}

/// Of those that are there.
std::optional<std::uint64_t> ItemStore::oldest(Stream stream) const {
  std::optional<std::uint64_t> oldest;
  const auto look = [&](const auto& items) {
    const auto first = items.lower_bound({stream, 0});
    if (first != items.end() && first->first.first == stream && (!oldest || first->first.second < *oldest))
      oldest = first->first.second;
  };
  look(memory_.items);
  look(spilled_.items);
  return oldest;
}

void ItemStore::clear() {
  memory_.items.clear();
  memory_.bytes = 0;
  spilled_.items.clear();
  spilled_.bytes = 0;
  read_back_.clear();
  lost_.clear();
  if (spill_) spill_->clear();
}

}  // namespace rds::transfer
