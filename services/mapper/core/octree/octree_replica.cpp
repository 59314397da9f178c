// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/octree/octree_replica.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_set>

#include <fmt/format.h>

#include "services/mapper/core/octree/label_table.hpp"
#include "services/mapper/core/octree/voxel_walk.hpp"

namespace rds::mapper {
namespace {

constexpr std::size_t kMaxVoxelsPerDelta = 20'000'000;
constexpr float kMaxLogOdds = 100;
constexpr double kSameResolution = 1e-9;  // m

std::uint64_t packed(const octomap::OcTreeKey& key) {
  return std::uint64_t{key[0]} << 32 | std::uint64_t{key[1]} << 16 | key[2];
}

octomap::OcTreeKey key_of(std::span<const std::uint16_t> keys, std::size_t row) {
  return {keys[3 * row], keys[3 * row + 1], keys[3 * row + 2]};
}

/// What is wrong with a delta's arrays; empty if nothing.
std::string malformed(const MapDelta& d) {
  const std::size_t n = d.log_odds.size();
  if (d.keys.size() != 3 * n || d.labels.size() != n || d.colors.size() != 3 * n ||
      d.deleted_keys.size() % 3 != 0)
    return fmt::format(
        "arrays of {} keys, {} log-odds, {} labels, {} colours, {} deleted keys do not fit each other",
        d.keys.size(), n, d.labels.size(), d.colors.size(), d.deleted_keys.size());
  if (n > kMaxVoxelsPerDelta || d.deleted_keys.size() / 3 > kMaxVoxelsPerDelta) return "too many voxels";
  if (!std::ranges::all_of(d.log_odds, [](float v) { return std::abs(v) <= kMaxLogOdds; }))
    return "log-odds that are not finite or too large";
  if (!(d.resolution > 1e-4 && d.resolution < 1e3)) return fmt::format("a resolution of {} m", d.resolution);
  if (d.revision <= d.base_revision) return fmt::format("revision {} after {}", d.revision, d.base_revision);
  return {};
}

ReplicaAnswer check_resolution(double told_m, const EditableOcTree& tree) {
  if (std::abs(told_m - tree.getResolution()) <= kSameResolution) return {};
  return {ReplicaStatus::kOtherResolution,
          fmt::format("voxels of {} m, have {} m", told_m, tree.getResolution())};
}

}  // namespace

std::uint16_t OctreeReplica::label(const octomap::OcTreeKey& key) const {
  const auto found = labels_.find(packed(key));
  return found == labels_.end() ? std::uint16_t{0} : found->second;
}

bool OctreeReplica::is_of(std::uint64_t map_epoch, std::uint64_t map_id) const {
  return tree_ && map_epoch == map_epoch_ && map_id == map_id_;
}

ReplicaAnswer OctreeReplica::check(const FullMap& full) const {
  if (full.label_keys.size() != 3 * full.label_values.size())
    return {ReplicaStatus::kMalformed,
            fmt::format("full map: {} keys for {} labels", full.label_keys.size(), full.label_values.size())};
  if (!is_of(full.map_epoch, full.map_id)) return {};
  if (auto answer = check_resolution(full.resolution, *tree_); answer.status != ReplicaStatus::kApplied)
    return answer;
  if (full.revision <= revision_)
    return {ReplicaStatus::kOld, fmt::format("full map of revision {}, have {}", full.revision, revision_)};
  return {};
}

ReplicaAnswer OctreeReplica::apply(const FullMap& full) {
  auto answer = check(full);
  if (answer.status != ReplicaStatus::kApplied) return answer;
  auto read = tree_from_bytes(full.payload, full.resolution);
  if (!read) return {ReplicaStatus::kMalformed, "full map: " + read.error()};
  tree_ = std::make_unique<EditableOcTree>(full.resolution);
  tree_->adopt(std::move(**read));
  map_epoch_ = full.map_epoch;
  map_id_ = full.map_id;
  revision_ = full.revision;
  take_labels(full);
  return answer;
}

void OctreeReplica::take_labels(const FullMap& full) {
  labels_.clear();
  const ColorLabels told(full.labels);
  for_each_voxel(*tree_, [&](const octomap::OcTreeKey& key, const EditableOcTree::Node& voxel) {
    const auto color = voxel.getColor();
    if (tree_->isNodeOccupied(voxel)) set_label(key, told.label_of({color.r, color.g, color.b}));
  });
  for (std::size_t row = 0; row < full.label_values.size(); ++row)
    set_label(key_of(full.label_keys, row), full.label_values[row]);
}

void OctreeReplica::set_label(const octomap::OcTreeKey& key, std::uint16_t label) {
  if (label != 0)
    labels_[packed(key)] = label;
  else
    labels_.erase(packed(key));
}

ReplicaAnswer OctreeReplica::check(const MapDelta& delta) const {
  if (auto fault = malformed(delta); !fault.empty()) return {ReplicaStatus::kMalformed, "delta: " + fault};
  if (!is_of(delta.map_epoch, delta.map_id)) {
    if (delta.base_revision == 0) return {};  // the first of its map
    return {tree_ ? ReplicaStatus::kOtherMap : ReplicaStatus::kGap,
            fmt::format("delta of map {:x}/{:x} from revision {}, no full map of it yet", delta.map_epoch,
                        delta.map_id, delta.base_revision)};
  }
  if (auto answer = check_resolution(delta.resolution, *tree_); answer.status != ReplicaStatus::kApplied)
    return answer;
  if (delta.revision <= revision_)
    return {ReplicaStatus::kOld, fmt::format("delta to revision {}, have {}", delta.revision, revision_)};
  if (delta.base_revision != revision_)
    return {ReplicaStatus::kGap,
            fmt::format("delta from revision {}, have {}", delta.base_revision, revision_)};
  return {};
}

ReplicaAnswer OctreeReplica::apply(const MapDelta& delta) {
  auto answer = check(delta);
  if (answer.status != ReplicaStatus::kApplied) return answer;
  if (!is_of(delta.map_epoch, delta.map_id)) {
    tree_ = std::make_unique<EditableOcTree>(delta.resolution);
    labels_.clear();
    map_epoch_ = delta.map_epoch;
    map_id_ = delta.map_id;
  }
  set_voxels(delta);
  delete_voxels(delta);
  if (tree_->getRoot() != nullptr) tree_->updateInnerOccupancy();
  revision_ = delta.revision;
  return answer;
}

void OctreeReplica::set_voxels(const MapDelta& delta) {
  std::array<EditableOcTree::Node*, EditableOcTree::kDepth + 1> path{};
  for (std::size_t row = 0; row < delta.log_odds.size(); ++row) {
    const auto key = key_of(delta.keys, row);
    auto* voxel = tree_->descend(key, EditableOcTree::kDepth, path);
    voxel->setLogOdds(delta.log_odds[row]);
    voxel->setColor(delta.colors[3 * row], delta.colors[3 * row + 1], delta.colors[3 * row + 2]);
    set_label(key, delta.labels[row]);
  }
}

// ColorOcTree::deleteNode leaves emptied inner nodes behind (and OctoMap asserts on them), so the rest is
// copied instead: voxels are deleted only when poses were corrected.
void OctreeReplica::delete_voxels(const MapDelta& delta) {
  if (delta.deleted_keys.empty()) return;
  std::unordered_set<std::uint64_t> deleted;
  for (std::size_t row = 0; row < delta.deleted_keys.size() / 3; ++row) {
    const auto key = packed(key_of(delta.deleted_keys, row));
    deleted.insert(key);
    labels_.erase(key);
  }
  auto rest = std::make_unique<EditableOcTree>(tree_->getResolution());
  std::array<EditableOcTree::Node*, EditableOcTree::kDepth + 1> path{};
  for (auto leaf = tree_->begin_leafs(), end = tree_->end_leafs(); leaf != end; ++leaf) {
    if (deleted.contains(packed(leaf.getKey()))) continue;
    auto* voxel = rest->descend(leaf.getKey(), EditableOcTree::kDepth, path);
    voxel->setLogOdds(leaf->getLogOdds());
    voxel->setColor(leaf->getColor());
  }
  tree_ = std::move(rest);
}

}  // namespace rds::mapper
