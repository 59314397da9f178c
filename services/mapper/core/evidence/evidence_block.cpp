// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/evidence/evidence_block.hpp"

#include <algorithm>
#include <ranges>
#include <span>

namespace rds::mapper {
namespace {

constexpr std::size_t kPrefixStep = 64;  // entries; a prefix takes the memory of some 25

EvidenceBlock::Rank rank_of(const EvidenceBlock::Entry& entry) {
  return {entry.time, entry.keyframe};
}

void count(const EvidenceBlock::Entry& entry, BlockCounts& counts) {
  if (!entry.has_sightings()) return;
  const BlockSight sight = entry.view->sight(entry.block);
  counts.statics.add(sight.seen_static(), entry.time);
  counts.dynamics.add(sight.near_dynamic, entry.time);
}

/// Finds cells in entries, the first of which tells of a cell.
/// @param tell  (cell, time).
template <class Entries, class Cells, class Tell>
void find_each(BlockMask& wanted, const Entries& entries, Cells cells_in, Tell tell) {
  for (auto entry = entries.begin(); entry != entries.end() && !wanted.empty(); ++entry) {
    if (!entry->has_sightings()) continue;
    const BlockMask found = cells_in(entry->view->sight(entry->block)) & wanted;
    found.for_each([&](std::size_t cell) { tell(cell, entry->time); });
    wanted &= ~found;
  }
  wanted = {};
}

/// Looks first and last times up where they are open. @param entries  by time. @param final_ones  before
/// them.
template <class Cells>
void look_up(Sightings& sightings, const Sightings& final_ones,
             std::span<const EvidenceBlock::Entry> entries, Cells cells_in) {
  auto& [count, first, last, first_is_open, last_is_open] = sightings;
  first_is_open.for_each([&](std::size_t cell) { first[cell] = final_ones.first[cell]; });
  last_is_open.for_each([&](std::size_t cell) { last[cell] = final_ones.last[cell]; });
  find_each(first_is_open, entries, cells_in,
            [&](std::size_t cell, EvidenceTime time) { first[cell] = std::min(first[cell], time); });
  find_each(last_is_open, std::views::reverse(entries), cells_in,
            [&](std::size_t cell, EvidenceTime time) { last[cell] = std::max(last[cell], time); });
}

}  // namespace

std::size_t EvidenceBlock::at_or_after(const Rank& rank) const {
  return static_cast<std::size_t>(std::ranges::lower_bound(entries_, rank, {}, rank_of) - entries_.begin());
}

std::optional<std::size_t> EvidenceBlock::find(const Rank& rank) const {
  const std::size_t at = at_or_after(rank);
  const bool is_there = at < entries_.size() && rank_of(entries_[at]) == rank && entries_[at].view;
  return is_there ? std::optional(at) : std::nullopt;
}

/// The entry, or what is in its place now, is not what was added up.
void EvidenceBlock::change_from(std::size_t entry) {
  changed_from_ = std::min(changed_from_.value_or(entry), entry);
  while (!prefixes_.empty() && prefixes_.back().entries > entry) prefixes_.pop_back();
}

void EvidenceBlock::add(Entry entry) {
  const std::size_t at = at_or_after(rank_of(entry));
  if (counts_) count(entry, *counts_);
  entry.view->for_each_look(entry.block, [&](std::uint16_t cell, const SurfaceLook& look) {
    looks_.add(cell, look);
    changed_.insert(cell);
  });
  const bool is_gap = at < entries_.size() && rank_of(entries_[at]) == rank_of(entry);
  if (at < added_up_) {
    change_from(at);
    if (!is_gap) ++added_up_;
  }
  if (is_gap)
    entries_[at] = std::move(entry);
  else
    entries_.insert(entries_.begin() + static_cast<std::ptrdiff_t>(at), std::move(entry));
}

void EvidenceBlock::remove(const Rank& rank) {
  const auto at = find(rank);
  if (!at) return;
  Entry& entry = entries_[*at];
  if (counts_ && entry.has_sightings()) {
    const BlockSight sight = entry.view->sight(entry.block);
    counts_->statics.remove(sight.seen_static(), entry.time);
    counts_->dynamics.remove(sight.near_dynamic, entry.time);
  }
  entry.view->for_each_look(entry.block, [&](std::uint16_t cell, const SurfaceLook& look) {
    looks_.remove(cell, look);
    changed_.insert(cell);
  });
  if (*at < added_up_) change_from(*at);
  entry.view.reset();
  has_gaps_ = true;
}

void EvidenceBlock::close_gaps() {
  if (!std::exchange(has_gaps_, false)) return;
  const auto first_new = entries_.begin() + static_cast<std::ptrdiff_t>(added_up_);
  added_up_ = static_cast<std::size_t>(
      std::count_if(entries_.begin(), first_new, [](const Entry& entry) { return entry.view != nullptr; }));
  std::erase_if(entries_, [](const Entry& entry) { return !entry.view; });
}

void EvidenceBlock::outdate(const Rank& rank) {
  if (const auto at = find(rank); at && *at < added_up_) change_from(*at);
}

void EvidenceBlock::begin_with(std::shared_ptr<const FinalBlock> known) {
  final_ = std::move(known);
  for (const auto& [cell, look] : final_->looks) looks_.add(cell, look);
  occupancy_ = final_->occupancy;
  changed_ = BlockMask::all();
}

void EvidenceBlock::make_final(const Rank& rank) {
  const auto at = find(rank);
  if (!at) return;
  const Entry& entry = entries_[*at];
  auto final_now = final_ ? std::make_shared<FinalBlock>(*final_) : std::make_shared<FinalBlock>();
  final_now->occupancy.add(entry.view->step(entry.block));
  count(entry, final_now->counts);
  entry.view->for_each_look(
      entry.block, [&](std::uint16_t cell, const SurfaceLook& look) { final_now->looks[cell].add(look); });
  final_ = std::move(final_now);
  if (*at > 0 || added_up_ == 0 || changed_from_) {  // else all is added up in the order in which it was
    change_from(0);
  } else {
    if (!prefixes_.empty() && prefixes_.front().entries == 0) prefixes_.erase(prefixes_.begin());
    for (Prefix& prefix : prefixes_) --prefix.entries;
  }
  if (*at < added_up_) --added_up_;
  entries_.erase(entries_.begin() + static_cast<std::ptrdiff_t>(*at));
}

const BlockCounts& EvidenceBlock::counts() {
  if (!counts_) {
    counts_ = std::allocate_shared<BlockCounts>(entries_.get_allocator(),
                                                final_ ? final_->counts : BlockCounts{});
    for (const Entry& entry : entries_) count(entry, *counts_);
  }
  static const BlockCounts kNone;
  const BlockCounts& final_ones = final_ ? final_->counts : kNone;
  look_up(counts_->statics, final_ones.statics, entries_,
          [](const BlockSight& sight) { return sight.seen_static(); });
  look_up(counts_->dynamics, final_ones.dynamics, entries_,
          [](const BlockSight& sight) { return sight.near_dynamic; });
  return *counts_;
}

std::size_t EvidenceBlock::not_added_up() const {
  if (!changed_from_) return entries_.size() - added_up_;
  return entries_.size() - (prefixes_.empty() ? 0 : prefixes_.back().entries);
}

void EvidenceBlock::update() {
  const BlockOccupancy before = occupancy_;
  close_gaps();
  if (changed_from_) {
    added_up_ = prefixes_.empty() ? 0 : prefixes_.back().entries;
    if (!prefixes_.empty())
      occupancy_ = prefixes_.back().occupancy;
    else
      occupancy_ = final_ ? final_->occupancy : BlockOccupancy{};
    changed_from_.reset();
  }
  while (added_up_ < entries_.size()) {
    const Entry& entry = entries_[added_up_++];
    occupancy_.add(entry.view->step(entry.block));
    if (added_up_ % kPrefixStep == 0) keep_prefix(added_up_);
  }
  changed_ |= occupancy_.changed_since(before);
}

void EvidenceBlock::add_newest() {
  const BlockOccupancy before = occupancy_;
  for (; added_up_ < entries_.size(); ++added_up_) {
    const Entry& entry = entries_[added_up_];
    if (entry.view) occupancy_.add(entry.view->step(entry.block));
  }
  changed_ |= occupancy_.changed_since(before);
}

/// Keeps the occupancy, and drops prefixes so that the gap between two is at most as wide as what comes
/// behind it: a change costs no more than twice the entries behind it, and a list of n has some log n of
/// them.
void EvidenceBlock::keep_prefix(std::size_t entries) {
  for (std::size_t i = 1; i + 1 < prefixes_.size();) {
    const std::size_t gap = prefixes_[i + 1].entries - prefixes_[i - 1].entries;
    if (gap <= entries - prefixes_[i + 1].entries)
      prefixes_.erase(prefixes_.begin() + static_cast<std::ptrdiff_t>(i));
    else
      ++i;
  }
  prefixes_.push_back({entries, occupancy_});
}

}  // namespace rds::mapper
