// SPDX-License-Identifier: Apache-2.0
#include "services/viewer/core/map/map_chunks.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "services/mapper/core/octree/voxel_walk.hpp"

namespace rds::viewer {
namespace {

using Node = octomap::ColorOcTreeNode;
constexpr unsigned kChunkDepth = mapper::EditableOcTree::kDepth - kChunkBits;
constexpr std::size_t kChunkHeaderBytes = 16;
constexpr std::size_t kVoxelBytes = 8;

octomap::OcTreeKey first_key(std::uint64_t chunk) {
  const auto at = [&](unsigned shift) {
    return static_cast<std::uint16_t>((chunk >> shift & 0xffff) << kChunkBits);
  };
  return {at(32), at(16), at(0)};
}

bool is_occupied(const Node& voxel) {
  return voxel.getLogOdds() > 0;
}

/// Probability of being occupied, ½ … 1, as 0 … 255.
std::uint8_t certainty(const Node& voxel) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(2 * voxel.getOccupancy() - 1, 0.0, 1.0) * 255));
}

/// Writes the occupied voxels of a chunk, in the order of VoxelWalk.
class ChunkWriter {
 public:
  ChunkWriter(const mapper::OctreeReplica& map, std::uint64_t chunk) : map_(map), base_(first_key(chunk)) {
    for (unsigned axis = 0; axis < 3; ++axis)
      header_.put(static_cast<std::uint16_t>(base_[axis] >> kChunkBits));
    header_.put(std::uint16_t{0});
  }

  Bytes write() {
    const auto& tree = map_.tree();
    const Node* node = tree.getRoot();
    for (unsigned depth = 0; node != nullptr && depth < kChunkDepth; ++depth) {
      if (!tree.nodeHasChildren(node)) break;  // pruned: it stands for all below
      const unsigned index =
          octomap::computeChildIdx(base_, static_cast<int>(mapper::EditableOcTree::kDepth - 1 - depth));
      node = tree.nodeChildExists(node, index) ? tree.getNodeChild(node, index) : nullptr;
    }
    if (node != nullptr) go(*node, base_, kChunkSide / 2);
    header_.put(count_);
    header_.put(std::uint32_t{0});
    header_.put_bytes(voxels_.bytes());
    return header_.take();
  }

 private:
  void go(const Node& node, const octomap::OcTreeKey& key, unsigned half) {
    if (half == 0) return put(node, key);
    const auto& tree = map_.tree();
    const bool is_pruned = !tree.nodeHasChildren(&node);
    for (unsigned i = 0; i < 8; ++i)
      if (is_pruned || tree.nodeChildExists(&node, i))
        go(is_pruned ? node : *tree.getNodeChild(&node, i), mapper::child_key(key, i, half), half / 2);
  }

  void put(const Node& voxel, const octomap::OcTreeKey& key) {
    if (!is_occupied(voxel)) return;
    const auto place = [&](unsigned axis) { return (key[axis] - base_[axis]) << (axis * kChunkBits); };
    const auto color = voxel.getColor();
    voxels_.put(static_cast<std::uint16_t>(place(0) | place(1) | place(2)));
    for (const std::uint8_t channel : {color.r, color.g, color.b, certainty(voxel)}) voxels_.put(channel);
    voxels_.put(map_.label(key));
    ++count_;
  }

  const mapper::OctreeReplica& map_;
  octomap::OcTreeKey base_;
  map_file::ByteWriter header_;
  map_file::ByteWriter voxels_;
  std::uint32_t count_ = 0;
};

std::uint64_t voxels_in(const Bytes& chunk) {
  return chunk.empty() ? 0 : (chunk.size() - kChunkHeaderBytes) / kVoxelBytes;
}

}  // namespace

void MapChunks::show(const mapper::OctreeReplica& map, const ChangedChunks& changed) {
  const bool is_other = map.map_epoch() != map_epoch_ || map.map_id() != map_id_;
  if (is_other) {
    const std::uint64_t generation = generation_ + 1;
    *this = {};
    generation_ = generation;
    map_epoch_ = map.map_epoch();
    map_id_ = map.map_id();
  }
  resolution_ = map.tree().getResolution();
  revision_ = map.revision();
  if (is_other || changed.all) return show_all(map);
  for (const std::uint64_t chunk : changed.chunks) put(chunk, ChunkWriter(map, chunk).write());
}

void MapChunks::show_all(const mapper::OctreeReplica& map) {
  std::set<std::uint64_t> present;
  mapper::for_each_voxel(map.tree(), [&](const octomap::OcTreeKey& key, const Node& voxel) {
    if (is_occupied(voxel)) present.insert(chunk_of(key[0], key[1], key[2]));
  });
  for (const auto& [chunk, shown] : chunks_) present.insert(chunk);
  for (const std::uint64_t chunk : present) put(chunk, ChunkWriter(map, chunk).write());
}

void MapChunks::put(std::uint64_t chunk, Bytes bytes) {
  const auto known = chunks_.find(chunk);
  if (known == chunks_.end() && voxels_in(bytes) == 0) return;
  if (known != chunks_.end() && known->second.bytes == bytes) return;
  Chunk& shown = known != chunks_.end() ? known->second : chunks_[chunk];
  voxels_ += voxels_in(bytes) - voxels_in(shown.bytes);
  by_sequence_.erase(shown.sequence);
  shown = {++sequence_, std::move(bytes)};
  by_sequence_[sequence_] = chunk;
}

std::optional<Bytes> MapChunks::next(MapCursor& cursor) const {
  if (map_id_ == 0 && map_epoch_ == 0) return std::nullopt;
  if (cursor.generation != generation_) cursor = {generation_, 0, false};
  if (cursor.complete && cursor.sequence == sequence_) return std::nullopt;
  map_file::ByteWriter body;
  std::uint32_t count = 0;
  auto at = by_sequence_.upper_bound(cursor.sequence);
  for (; at != by_sequence_.end() && body.bytes().size() < kFrameBytes; ++at, ++count) {
    body.put_bytes(chunks_.at(at->second).bytes);
    cursor.sequence = at->first;
  }
  cursor.complete = at == by_sequence_.end();
  if (cursor.complete) cursor.sequence = sequence_;
  auto frame = begin_frame(Kind::kMap);
  frame.put(generation_);
  frame.put(resolution_);
  frame.put(revision_);
  frame.put(count);
  frame.put(std::uint32_t{cursor.complete});
  frame.put_bytes(body.bytes());
  return frame.take();
}

}  // namespace rds::viewer
