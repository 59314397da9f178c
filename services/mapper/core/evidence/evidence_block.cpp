// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/evidence/evidence_block.hpp"

#include <algorithm>

namespace rds::mapper {
namespace {

bool matters(const EvidenceBlock::Entry& entry) {
  return entry.view->is_equivocal(entry.block) || entry.view->has_surfaces(entry.block);
}

void count(const EvidenceBlock::Entry& entry, BlockCounts& counts) {
  if (!matters(entry)) return;
  BlockObservations observations;
  entry.view->unpack(entry.block, observations);
  counts.add(observations, entry.time);
}

}  // namespace

void EvidenceBlock::add(const Entry& entry) {
  const auto at = at_or_after(entry.keyframe);
  is_outdated_ |= is_added_up(at);
  is_equivocal_ |= entry.view->is_equivocal(entry.block);
  if (counts_) count(entry, *counts_);
  entries_.insert(at, entry);
}

void EvidenceBlock::remove(std::uint64_t keyframe) {
  const auto at = at_or_after(keyframe);
  if (at == entries_.end() || at->keyframe != keyframe) return;
  if (is_added_up(at)) {
    is_outdated_ = true;
    --added_up_;
  }
  if (matters(*at)) counts_.reset();
  entries_.erase(at);
}

void EvidenceBlock::outdate(std::uint64_t keyframe) {
  is_outdated_ |= is_added_up(at_or_after(keyframe));
}

EvidenceBlock::Entries::iterator EvidenceBlock::at_or_after(std::uint64_t keyframe) {
  return std::ranges::lower_bound(entries_, keyframe, {}, &Entry::keyframe);
}

void EvidenceBlock::remove_look(std::uint16_t cell, const SurfaceLook& look) {
  const auto found = looks_.find(cell);
  if (found == looks_.end()) return;
  found->second.remove(look);
  if (found->second.empty()) looks_.erase(found);
}

void EvidenceBlock::begin_with(const FinalBlock& known) {
  final_ = std::make_unique<FinalBlock>(known);
  looks_ = {known.looks.begin(), known.looks.end()};
  is_equivocal_ = std::ranges::any_of(known.counts.dynamics, [](auto n) { return n > 0; });
  is_outdated_ = true;
}

void EvidenceBlock::make_final(std::uint64_t keyframe,
                               const std::vector<std::pair<std::uint16_t, SurfaceLook>>& looks) {
  const auto at = at_or_after(keyframe);
  if (at == entries_.end() || at->keyframe != keyframe) return;
  update();
  if (!final_) final_ = std::make_unique<FinalBlock>();
  add_to(final_->log_odds, *at);
  count(*at, final_->counts);
  for (const auto& [cell, look] : looks) final_->looks[cell].add(look);
  is_outdated_ = at != entries_.begin();  // else all is added up in the order in which it was
  entries_.erase(at);
  --added_up_;
}

const BlockCounts& EvidenceBlock::counts() {
  if (counts_) return *counts_;
  counts_ = std::make_unique<BlockCounts>(final_ ? final_->counts : BlockCounts{});
  for (const Entry& entry : entries_) count(entry, *counts_);
  return *counts_;
}

void EvidenceBlock::update() {
  is_outdated_ |= is_equivocal_ && !verdicts_;
  if (is_outdated_)
    add_up_all();
  else if (added_up_ < entries_.size())
    add_up_new();
}

/// All entries, one after the other.
void EvidenceBlock::add_up_all() {
  if (is_equivocal_) verdicts_ = std::make_unique<BlockVerdicts>(decide(counts()));
  log_odds_ = final_ ? final_->log_odds : BlockLogOdds{};
  for (const Entry& entry : entries_) add_to(log_odds_, entry);
  added_up_ = entries_.size();
  is_outdated_ = false;
}

/// Entries newer than all others: what they change is less than all, if they leave the verdicts as they are.
void EvidenceBlock::add_up_new() {
  if (is_equivocal_ && decide(counts()) != *verdicts_) return add_up_all();
  for (auto entry = first_new(); entry != entries_.end(); ++entry) add_to(log_odds_, *entry);
  added_up_ = entries_.size();
}

void EvidenceBlock::add_to(BlockLogOdds& log_odds, const Entry& entry) const {
  BlockObservations observations;
  entry.view->unpack_decided(entry.block, observations);
  if (is_equivocal_)
    log_odds.add(observations, entry.time, *verdicts_);
  else
    log_odds.add_plain(observations);
}

}  // namespace rds::mapper
