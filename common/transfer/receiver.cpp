// SPDX-License-Identifier: Apache-2.0
#include "common/transfer/receiver.hpp"

#include <algorithm>
#include <utility>

namespace rds::transfer {

void Receiver::offer(const Offer& offer, Time now) {
  if (!std::exchange(was_offered_, true)) statistics_.given_up += offer.lost;
  statistics_.given_up += wanted_.offer(offer);
  if (lacking() > 0) deadlines_.note(*wanted_.missing().rbegin(), now);
  while (!begun_.empty() && begun_.begin()->first < offer.oldest) finish(begun_.begin()->first);
}

std::optional<Item> Receiver::take(const Chunk& chunk, Time now) {
  arrive({chunk.number, chunk.index}, now);
  const auto begun = begun_.find(chunk.number);
  if (begun == begun_.end()) {
    ++statistics_.repeated;
    return std::nullopt;
  }
  if (chunk.item_bytes == kAbsent || chunk.item_bytes == kLost) {
    ++(chunk.item_bytes == kLost ? statistics_.given_up : statistics_.absent);
    finish(chunk.number);
    return std::nullopt;
  }
  Assembly& assembly = begun->second.assembly;
  add(chunk, assembly);
  if (!assembly.complete()) return std::nullopt;
  ++statistics_.items;
  latest_chunks_ = chunks_in(assembly.size());
  Item item{chunk.number, std::move(assembly.bytes())};
  finish(chunk.number);
  return item;
}

std::vector<Request> Receiver::due(Time now, bool may_begin) {
  give_up_lost(now);
  std::vector<Request> requests;
  while (in_flight_.size() < window_.chunks()) {
    const auto next = next_chunk(may_begin);
    if (!next) break;
    const auto& [number, chunk] = *next;
    const bool again = begun_.at(number).assembly.ask(chunk);
    order_of_[*next] = next_order_;
    in_flight_.emplace(next_order_++, Asked{*next, now, again});
    const bool follows = !requests.empty() && requests.back().number == number &&
                         requests.back().first + requests.back().count == chunk;
    if (!follows) requests.push_back({number, chunk, 0});
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

std::size_t Receiver::overdue(Time now) const {
  const auto newest = deadlines_.passed(now);
  if (!newest) return 0;
  const auto& missing = wanted_.missing();
  std::size_t in_time = 0;  // few
  for (auto it = missing.rbegin(); it != missing.rend() && *it > *newest; ++it) ++in_time;
  return missing.size() - in_time;
}

std::optional<Time> Receiver::next_overdue(Time now) const {
  return lacking() > 0 ? deadlines_.next(now) : std::nullopt;
}

/// What was asked for is there, whatever becomes of it.
void Receiver::arrive(const ChunkId& chunk, Time now) {
  const auto order = order_of_.find(chunk);
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
  const ChunkId lost = asked->second.chunk;
  begun_.at(lost.first).assembly.lost(lost.second);
  ++statistics_.asked_again;
  order_of_.erase(lost);
  in_flight_.erase(asked);
}

void Receiver::add(const Chunk& chunk, Assembly& assembly) {
  const bool first = assembly.size() == 0;
  const Assembly::Verdict verdict = assembly.take(chunk);
  if (first && assembly.size() > 0) forget_asked(chunk.number, chunks_in(assembly.size()));
  ++(verdict == Assembly::Verdict::kTaken      ? statistics_.chunks
     : verdict == Assembly::Verdict::kRepeated ? statistics_.repeated
                                               : statistics_.impossible);
}

/// The item is here, or cannot be had.
void Receiver::finish(std::uint64_t number) {
  wanted_.remove(number);
  begun_.erase(number);
  forget_asked(number, 0);
}

/// Of an item that is over, or of its end that does not exist.
void Receiver::forget_asked(std::uint64_t number, std::uint32_t first_chunk) {
  auto it = order_of_.lower_bound({number, first_chunk});
  while (it != order_of_.end() && it->first.first == number) {
    in_flight_.erase(it->second);
    it = order_of_.erase(it);
  }
}

/// Of the item that was begun first and has a chunk to ask for; else an item is begun.
std::optional<Receiver::ChunkId> Receiver::next_chunk(bool may_begin) {
  auto earliest = begun_.end();
  for (auto it = begun_.begin(); it != begun_.end(); ++it)
    if (it->second.assembly.next() && (earliest == begun_.end() || it->second.turn < earliest->second.turn))
      earliest = it;
  if (earliest == begun_.end()) {
    const auto next = may_begin ? next_item() : std::nullopt;
    if (!next) return std::nullopt;
    earliest = begun_.emplace(*next, Begun{++turn_, Assembly(first_chunks())}).first;
  }
  return ChunkId(earliest->first, *earliest->second.assembly.next());
}

/// Most of what the item before had: a round trip is saved, and little is asked for that does not exist.
std::uint32_t Receiver::first_chunks() const {
  return std::max(Assembly::kFirstChunks, latest_chunks_ / 4 * 3);
}

/// In the order of numbers one at a time, as a later one could be whole before.
std::optional<std::uint64_t> Receiver::next_item() const {
  const auto& missing = wanted_.missing();
  if (missing.empty() || begun_.size() >= (order_ == Order::kNewest ? kMostBegun : 1)) return std::nullopt;
  if (order_ == Order::kNumber) return *missing.begin();
  const auto newest = std::find_if(missing.rbegin(), missing.rend(),
                                   [&](std::uint64_t number) { return !begun_.contains(number); });
  return newest == missing.rend() ? std::nullopt : std::optional(*newest);
}

}  // namespace rds::transfer
