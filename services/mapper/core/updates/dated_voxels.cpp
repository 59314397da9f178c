// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/updates/dated_voxels.hpp"

#include <algorithm>

#include "services/mapper/core/updates/morton.hpp"

namespace rds::mapper {
namespace {

/// Deleted voxels are remembered up to this share of all, so that memory follows the map.
constexpr double kMostDeleted = 0.5;

octomap::OcTreeKey key_at(const std::vector<std::uint16_t>& keys, std::size_t row) {
  return {keys[3 * row], keys[3 * row + 1], keys[3 * row + 2]};
}

MapDelta without_arrays(const MapDelta& delta) {
  MapDelta head;
  head.map_epoch = delta.map_epoch;
  head.map_id = delta.map_id;
  head.base_revision = delta.base_revision;
  head.revision = delta.revision;
  head.keyframe_id = delta.keyframe_id;
  head.stamp_ns = delta.stamp_ns;
  head.resolution = delta.resolution;
  return head;
}

}  // namespace

DatedVoxels::DatedVoxels(const MapDelta& whole)
    : head_(without_arrays(whole)), deletions_known_since_(whole.revision) {
  set(whole);
}

bool DatedVoxels::add(const MapDelta& delta) {
  if (delta.map_id != head_.map_id || delta.base_revision != head_.revision) return false;
  head_ = without_arrays(delta);
  set(delta);
  return true;
}

void DatedVoxels::set(const MapDelta& delta) {
  for (std::size_t row = 0; row < delta.log_odds.size(); ++row)
    put({morton_of(key_at(delta.keys, row)),
         delta.revision,
         delta.log_odds[row],
         delta.labels[row],
         {delta.colors[3 * row], delta.colors[3 * row + 1], delta.colors[3 * row + 2]}});
  for (std::size_t row = 0; row < delta.deleted_keys.size() / 3; ++row)
    put({.morton = morton_of(key_at(delta.deleted_keys, row)),
         .revision = delta.revision,
         .is_deleted = true});
  insert_new();
  forget_deleted();
}

void DatedVoxels::put(const Voxel& voxel) {
  const auto place = std::ranges::lower_bound(voxels_, voxel.morton, {}, &Voxel::morton);
  if (place == voxels_.end() || place->morton != voxel.morton) return new_.push_back(voxel);
  deleted_ = deleted_ + (voxel.is_deleted ? 1 : 0) - (place->is_deleted ? 1 : 0);
  *place = voxel;
}

void DatedVoxels::insert_new() {
  std::ranges::sort(new_, {}, &Voxel::morton);
  deleted_ += static_cast<std::size_t>(std::ranges::count(new_, true, &Voxel::is_deleted));
  const auto before = static_cast<std::ptrdiff_t>(voxels_.size());
  voxels_.insert(voxels_.end(), new_.begin(), new_.end());
  std::ranges::inplace_merge(voxels_, voxels_.begin() + before, {}, &Voxel::morton);
  new_.clear();
}

void DatedVoxels::forget_deleted() {
  if (static_cast<double>(deleted_) <= kMostDeleted * static_cast<double>(voxels_.size())) return;
  std::erase_if(voxels_, [](const Voxel& voxel) { return voxel.is_deleted; });
  deleted_ = 0;
  deletions_known_since_ = head_.revision;
}

std::optional<MapDelta> DatedVoxels::since(std::uint64_t revision) const {
  if (revision > head_.revision || (revision > 0 && revision < deletions_known_since_)) return std::nullopt;
  MapDelta delta = head_;
  delta.base_revision = revision;
  for (const Voxel& voxel : voxels_) {
    if (voxel.revision <= revision) continue;
    const octomap::OcTreeKey key = key_of_morton(voxel.morton);
    if (voxel.is_deleted) {
      if (revision > 0) delta.deleted_keys.insert(delta.deleted_keys.end(), {key[0], key[1], key[2]});
      continue;
    }
    delta.keys.insert(delta.keys.end(), {key[0], key[1], key[2]});
    delta.log_odds.push_back(voxel.log_odds);
    delta.labels.push_back(voxel.label);
    delta.colors.insert(delta.colors.end(), voxel.color.begin(), voxel.color.end());
  }
  return delta;
}

}  // namespace rds::mapper
