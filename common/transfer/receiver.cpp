// SPDX-License-Identifier: Apache-2.0
#include "common/transfer/receiver.hpp"

#include <algorithm>

namespace rds::transfer {

void Receiver::have(const ItemId& item) {
  if (auto& stream = streams_[index(item.stream)]) stream->wanted.remove(item.number);
  begun_.erase(item);
  forget_asked(item, 0);
}

void Receiver::offer(const Offer& offer) {
  auto& stream = streams_[index(offer.stream)];
  if (!stream) return;
  stream->wanted.offer(offer);
  std::vector<ItemId> over;
  for (const auto& [item, begun] : begun_)
    if (item.stream == offer.stream && item.number < offer.oldest) over.push_back(item);
  for (const ItemId& item : over) have(item);
}

std::optional<Item> Receiver::take(const Chunk& chunk, Time now) {
  arrive(chunk, now);
  const auto begun = begun_.find(chunk.item);
  if (begun == begun_.end()) {
    ++statistics_.repeated;
    return std::nullopt;
  }
  if (chunk.item_bytes == 0) {
    ++statistics_.absent;
    have(chunk.item);
    return std::nullopt;
  }
  Assembly& assembly = begun->second.assembly;
  add(chunk, assembly);
  if (!assembly.complete()) return std::nullopt;
  Item item{chunk.item, std::move(assembly.bytes())};
  ++statistics_.items;
  have(chunk.item);
  return item;
}

std::vector<Request> Receiver::due(Time now) {
  give_up_lost(now);
  std::vector<Request> requests;
  while (in_flight_.size() < window_.chunks()) {
    const auto next = next_chunk();
    if (!next) break;
    const auto& [item, chunk] = *next;
    const bool again = begun_.at(item).assembly.ask(chunk);
    order_of_[*next] = next_order_;
    in_flight_.emplace(next_order_++, Asked{item, chunk, now, again});
    const bool follows = !requests.empty() && requests.back().item == item &&
                         requests.back().first + requests.back().count == chunk;
    if (!follows) requests.push_back({item, chunk, 0});
    ++requests.back().count;
  }
  return requests;
}

std::optional<Time> Receiver::next_due() const {
  if (in_flight_.empty()) return std::nullopt;
  const auto& [order, oldest] = *in_flight_.begin();
  const Time silent = std::max(last_arrival_, in_flight_.rbegin()->second.at) + window_.timeout();
  if (order >= overtaken_) return silent;
  return std::min(silent, oldest.at + window_.round_trip() + window_.reordering());
}

std::size_t Receiver::lacking(Stream stream) const {
  const auto& state = streams_[index(stream)];
  return state ? state->wanted.missing().size() : 0;
}

/// What was asked for is there, whatever becomes of it.
void Receiver::arrive(const Chunk& chunk, Time now) {
  const auto order = order_of_.find({chunk.item, chunk.index});
  if (order == order_of_.end()) return;
  const auto asked = in_flight_.find(order->second);
  window_.arrived(now, now - asked->second.at, asked->second.again, in_flight_.size());
  overtaken_ = std::max(overtaken_, asked->first);
  last_arrival_ = now;
  in_flight_.erase(asked);
  order_of_.erase(order);
}

/// Chunks that were overtaken by others, and by so much that they are not merely late; all, after a silence.
void Receiver::give_up_lost(Time now) {
  if (in_flight_.empty()) return;
  const Time newest = in_flight_.rbegin()->second.at;
  if (now - std::max(last_arrival_, newest) >= window_.timeout()) {
    while (!in_flight_.empty()) lose(in_flight_.begin());
    window_.silent();
  }
  const Time late = now - window_.round_trip() - window_.reordering();
  while (!in_flight_.empty() && in_flight_.begin()->first < overtaken_ &&
         in_flight_.begin()->second.at <= late) {
    lose(in_flight_.begin());
    window_.lost(now);
  }
}

void Receiver::lose(Orders::iterator asked) {
  const Asked lost = asked->second;
  const auto begun = begun_.find(lost.item);
  if (begun != begun_.end()) begun->second.assembly.lost(lost.chunk);
  ++statistics_.asked_again;
  order_of_.erase({lost.item, lost.chunk});
  in_flight_.erase(asked);
}

void Receiver::add(const Chunk& chunk, Assembly& assembly) {
  const bool first = assembly.size() == 0;
  const Assembly::Verdict verdict = assembly.take(chunk);
  if (first && assembly.size() > 0) forget_asked(chunk.item, chunks_in(assembly.size()));
  ++(verdict == Assembly::Verdict::kTaken      ? statistics_.chunks
     : verdict == Assembly::Verdict::kRepeated ? statistics_.repeated
                                               : statistics_.impossible);
}

/// Of an item that is over, or of its end that does not exist.
void Receiver::forget_asked(const ItemId& item, std::uint32_t first_chunk) {
  auto it = order_of_.lower_bound({item, first_chunk});
  while (it != order_of_.end() && it->first.first == item) {
    in_flight_.erase(it->second);
    it = order_of_.erase(it);
  }
}

/// Of the item that was begun first and has a chunk to ask for; else an item is begun.
std::optional<std::pair<ItemId, std::uint32_t>> Receiver::next_chunk() {
  const Begun* earliest = nullptr;
  ItemId item;
  for (const auto& [id, begun] : begun_) {
    if (!begun.assembly.next() || (earliest != nullptr && earliest->turn < begun.turn)) continue;
    earliest = &begun;
    item = id;
  }
  if (earliest == nullptr) {
    const std::optional<ItemId> next = begun_.size() < kMostBegun ? next_item() : std::nullopt;
    if (!next) return std::nullopt;
    item = *next;
    earliest = &begun_.emplace(item, Begun{++turn_, {}}).first->second;
    streams_[index(item.stream)]->turn = turn_;
  }
  return std::pair(item, *earliest->assembly.next());
}

/// The newest of a stream before what is older; of two streams the one whose turn is longer ago.
std::optional<ItemId> Receiver::next_item() const {
  std::optional<ItemId> best;
  std::pair<bool, std::uint64_t> best_rank;
  for (std::size_t i = 0; i < kStreams; ++i) {
    if (!streams_[i]) continue;
    const auto& missing = streams_[i]->wanted.missing();
    const auto newest = std::find_if(missing.rbegin(), missing.rend(), [&](std::uint64_t number) {
      return !begun_.contains({static_cast<Stream>(i), number});
    });
    if (newest == missing.rend()) continue;
    const std::pair rank(!streams_[i]->wanted.is_newest(*newest), streams_[i]->turn);
    if (best && best_rank <= rank) continue;
    best = ItemId{static_cast<Stream>(i), *newest};
    best_rank = rank;
  }
  return best;
}

}  // namespace rds::transfer
