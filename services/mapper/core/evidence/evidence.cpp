// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/evidence/evidence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace rds::mapper {
namespace {

constexpr std::int64_t kNsPerMs = 1'000'000;
constexpr std::int64_t kLongest = kAfterAll - 10'000;  // 12 days; what is farther is as far

constexpr std::size_t kJudgedAgain = 10;  // keyframes, with each update
// Entries of blocks' lists that are added up, some .4 µs each: in a block that was touched, at once; in one
// update, of those that are behind.
constexpr std::size_t kAtOnce = 192;
constexpr std::size_t kCaughtUp = 100'000;

/// Voxels of a surface.
struct SurfaceSupport {
  std::uint32_t voxels = 0;
  std::uint32_t doubtful = 0;   // or unknown
  std::uint32_t confirmed = 0;  // seen as static at another time
  std::uint32_t transient = 0;  // that bear no label
};

constexpr double kConfirmedShare = 0.7;
constexpr double kConfirmedShareOfLarge = 0.15;  // walls and floors fill the picture, people do not
constexpr double kTransientShare = 0.8;

SurfaceVerdict verdict_on(const SurfaceSupport& surface, bool is_large) {
  const double voxels = surface.voxels;
  if (surface.transient > 0 && surface.transient >= kTransientShare * voxels)
    return SurfaceVerdict::kTransient;
  if (surface.doubtful == 0) return SurfaceVerdict::kUndecided;
  const double needed = is_large ? kConfirmedShareOfLarge : kConfirmedShare;
  return surface.confirmed > 0 && surface.confirmed >= needed * voxels ? SurfaceVerdict::kConfirmed
                                                                       : SurfaceVerdict::kUndecided;
}

std::int64_t floor_ms(std::int64_t time_ns) {
  return time_ns / kNsPerMs - (time_ns % kNsPerMs < 0 ? 1 : 0);
}

}  // namespace

Evidence::Evidence(double apart_s, std::pmr::memory_resource* memory)
    : apart_(static_cast<EvidenceTime>(std::lround(1000 * apart_s))),
      memory_({.max_blocks_per_chunk = 64, .largest_required_pool_block = std::size_t{64} << 10U}, memory) {}

void Evidence::begin_with(const FinalMap& known) {
  origin_ms_ = known.origin_ms;
  for (const auto& [key, block] : known.blocks) touch(key).begin_with(block);
}

EvidenceTime Evidence::time_of(std::int64_t time_ns) {
  if (!origin_ms_) origin_ms_ = floor_ms(time_ns);
  return static_cast<EvidenceTime>(std::clamp(floor_ms(time_ns) - *origin_ms_, -kLongest, kLongest));
}

EvidenceBlock& Evidence::touch(BlockKey key) {
  Place& place = blocks_.try_emplace(key, &memory_).first->second;
  if (!place.is_touched) touched_.push_back(key);
  place.is_touched = true;
  return place.evidence;
}

void Evidence::add(std::uint64_t keyframe, std::int64_t time_ns, const KeyframeView& contribution) {
  const auto view = std::make_shared<KeyframeView>(contribution, &memory_);
  const EvidenceTime time = time_of(time_ns);
  for (std::uint32_t i = 0; i < view->size(); ++i) touch(packed(view->key(i))).add({keyframe, time, i, view});
  keyframes_[keyframe] = {time, view};
  new_.push_back(keyframe);
}

void Evidence::remove(std::uint64_t keyframe) {
  const auto removed = keyframes_.extract(keyframe);
  if (!removed) return;
  const auto& [time, view] = removed.mapped();
  for (std::size_t i = 0; i < view->size(); ++i) touch(packed(view->key(i))).remove({time, keyframe});
}

void Evidence::make_final(std::uint64_t keyframe) {
  const auto removed = keyframes_.extract(keyframe);
  if (!removed) return;
  const auto& [time, view] = removed.mapped();
  for (std::size_t i = 0; i < view->size(); ++i) touch(packed(view->key(i))).make_final({time, keyframe});
}

/// Decides which surfaces of a keyframe count, by what all keyframes have seen.
void Evidence::judge(std::uint64_t id, Keyframe& keyframe) {
  KeyframeView& view = *keyframe.view;
  std::vector<SurfaceSupport> support(view.is_large().size());
  for (std::size_t i = 0; i < view.size(); ++i) {
    if (!view.has_surfaces(i)) continue;
    const BlockCounts& counts = blocks_.at(packed(view.key(i))).evidence.counts();
    const BlockSight sight = view.sight(i);
    view.for_each_surface_voxel(i, sight.surfaces(), [&](std::size_t cell, SurfacePart part) {
      SurfaceSupport& surface = support[part.surface];
      ++surface.voxels;
      surface.doubtful += sight.stable.has(cell) ? 0U : 1U;
      surface.confirmed += seen_apart(counts, cell, keyframe.time, apart_) ? 1U : 0U;
      surface.transient += part.is_labelled == 0 && is_transient(counts, cell, apart_) ? 1U : 0U;
    });
  }
  std::vector<SurfaceVerdict> verdicts(support.size(), SurfaceVerdict::kUndecided);
  for (std::size_t s = 1; s < support.size(); ++s) verdicts[s] = verdict_on(support[s], view.is_large()[s]);
  if (verdicts == view.verdicts()) return;
  const auto before = view.verdicts();
  view.set_verdicts(std::move(verdicts));
  for (std::size_t i = 0; i < view.size(); ++i) {
    if (!view.has_surfaces(i)) continue;
    bool is_changed = false;
    view.for_each_surface_voxel(i, view.sight(i).surfaces(), [&](std::size_t, SurfacePart part) {
      is_changed |= before[part.surface] != view.verdicts()[part.surface];
    });
    if (is_changed) touch(packed(view.key(i))).outdate({keyframe.time, id});
  }
}

void Evidence::update(const Show& show) {
  for (const std::uint64_t keyframe : new_)
    if (const auto found = keyframes_.find(keyframe); found != keyframes_.end())
      judge(keyframe, found->second);
  new_.clear();
  auto next = keyframes_.upper_bound(judged_last_);
  for (std::size_t i = 0; i < std::min(kJudgedAgain, keyframes_.size()); ++i) {
    if (next == keyframes_.end()) next = keyframes_.begin();
    judge(next->first, next->second);
    judged_last_ = next++->first;
  }
  show_touched(kAtOnce, show);
  for (std::size_t added_up = 0; added_up < kCaughtUp && !behind_.empty(); behind_.pop_front())
    added_up += catch_up(behind_.front(), show);
}

void Evidence::update_all(const Show& show) {
  new_.clear();
  for (auto& [id, keyframe] : keyframes_) judge(id, keyframe);
  show_touched(std::numeric_limits<std::size_t>::max(), show);
  for (; !behind_.empty(); behind_.pop_front()) catch_up(behind_.front(), show);
}

/// @param limit  of entries that are added up at once in one block.
void Evidence::show_touched(std::size_t limit, const Show& show) {
  for (const BlockKey key : touched_) {
    Place& place = blocks_.at(key);
    place.is_touched = false;
    if (place.evidence.not_added_up() <= limit) {
      place.evidence.update();
    } else {
      place.evidence.add_newest();
      if (!std::exchange(place.is_behind, true)) behind_.push_back(key);
    }
    show_block(key, show);
  }
  touched_.clear();
}

/// @return how many entries it has added up.
std::size_t Evidence::catch_up(BlockKey key, const Show& show) {
  const auto found = blocks_.find(key);
  if (found == blocks_.end()) return 0;
  found->second.is_behind = false;
  const std::size_t entries = found->second.evidence.not_added_up();
  found->second.evidence.update();
  show_block(key, show);
  return entries;
}

void Evidence::show_block(BlockKey key, const Show& show) {
  EvidenceBlock& block = blocks_.at(key).evidence;
  if (const BlockMask changed = block.take_changed(); !changed.empty()) show(unpacked(key), block, changed);
  if (block.empty()) blocks_.erase(key);
}

FinalMap Evidence::final_map() const {
  FinalMap map;
  map.origin_ms = origin_ms_;
  for (const auto& [key, place] : blocks_)
    if (place.evidence.final_part()) map.blocks.emplace(key, place.evidence.final_part());
  return map;
}

const EvidenceBlock* Evidence::block(const octomap::OcTreeKey& voxel) const {
  const auto found = blocks_.find(packed(block_key(voxel)));
  return found == blocks_.end() ? nullptr : &found->second.evidence;
}

}  // namespace rds::mapper
