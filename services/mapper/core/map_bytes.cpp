// SPDX-License-Identifier: Apache-2.0
// The map as bytes and back: what of each part cannot be computed again.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "common/map_file/checksum.hpp"
#include "common/map_file/geometry_bytes.hpp"
#include "services/mapper/core/semantic_mapper.hpp"
#include "services/mapper/core/tree_bytes.hpp"

namespace rds::mapper {
namespace {

using map_file::ByteReader;
using map_file::ByteWriter;

constexpr std::size_t kVoxelBytes = 8 + 12 + 2 + 2 + 3 * 4;
constexpr std::size_t kObjectBytes = 8 + 8 + 4 + 16 + 1 + 48 + 24;
constexpr std::uint64_t kLastKey = 0xFFFF'FFFF'FFFF;
constexpr double kSameResolution = 1e-9;  // m

std::string other_resolution(double saved_m, double expected_m) {
  return fmt::format("voxels of {} m, expected {} m", saved_m, expected_m);
}

}  // namespace

void put(ByteWriter& writer, const LabelTable& labels) {
  writer.put_count(labels.names().size() - 1);
  for (std::size_t i = 1; i < labels.names().size(); ++i) writer.put_text(labels.names()[i]);
}

LabelTable get_labels(ByteReader& reader) {
  LabelTable labels;
  const std::size_t count = reader.get_count(sizeof(std::uint64_t));
  for (std::size_t i = 1; i <= count && reader.ok(); ++i)
    if (labels.index_of(reader.get_text()) != i) reader.refuse("a label twice, or too many");
  return labels;
}

void VoxelMemory::put(ByteWriter& writer) const {
  for (const float channel : mean_rgb_) writer.put(channel);
  writer.put(times_seen_);
  writer.put(votes_cast_);
  for (const Votes& votes : votes_) {
    writer.put(votes.label);
    writer.put(votes.count);
  }
}

VoxelMemory VoxelMemory::get(ByteReader& reader, std::size_t labels) {
  VoxelMemory memory;
  for (float& channel : memory.mean_rgb_) {
    channel = reader.get<float>();
    if (channel < 0 || channel > 255) reader.refuse("a colour outside 0 … 255");
  }
  memory.times_seen_ = reader.get<std::uint16_t>();
  memory.votes_cast_ = reader.get<std::uint16_t>();
  for (Votes& votes : memory.votes_) {
    votes.label = reader.get<std::uint16_t>();
    votes.count = reader.get<std::uint16_t>();
    if (votes.label >= labels) reader.refuse(fmt::format("label {} of {}", votes.label, labels));
  }
  return memory;
}

void SemanticOctree::put(ByteWriter& writer) const {
  const auto nodes = to_bytes(tree_);
  writer.put(tree_.getResolution());
  writer.put_count(nodes.size());
  writer.put_bytes(nodes);
  std::vector<std::uint64_t> keys;
  keys.reserve(memory_.size());
  for (const auto& [key, memory] : memory_) keys.push_back(key);
  std::ranges::sort(keys);
  writer.put_count(keys.size());
  for (const std::uint64_t key : keys) {
    writer.put(key);
    memory_.at(key).put(writer);
  }
}

void SemanticOctree::get(ByteReader& reader, std::size_t labels) {
  const auto resolution = reader.get<double>();
  if (reader.ok() && std::abs(resolution - config_.resolution_m) > kSameResolution)
    reader.refuse(other_resolution(resolution, config_.resolution_m));
  const auto nodes = reader.get_bytes(reader.get_count(1));
  if (!reader.ok()) return;
  auto tree = tree_from_bytes(nodes, config_.resolution_m);
  if (!tree) return reader.refuse(tree.error());
  tree_.adopt(std::move(**tree));
  memory_.clear();
  const std::size_t voxels = reader.get_count(kVoxelBytes);
  for (std::size_t i = 0; i < voxels && reader.ok(); ++i) {
    const auto key = reader.get<std::uint64_t>();
    if (key > kLastKey || !memory_.emplace(key, VoxelMemory::get(reader, labels)).second)
      reader.refuse("a voxel twice, or outside of any map");
  }
}

void ObjectDatabase::put(ByteWriter& writer) const {
  writer.put(next_id_);
  writer.put_count(entries_.size());
  for (const Entry& entry : entries_) {
    writer.put(entry.object.id);
    writer.put_text(entry.object.label);
    writer.put(entry.object.observations);
    writer.put(entry.object.first_seen_ns);
    writer.put(entry.object.last_seen_ns);
    writer.put(static_cast<std::uint8_t>(entry.object.movable));
    map_file::put(writer, entry.min);
    map_file::put(writer, entry.max);
    for (const double sum : {entry.weight, entry.score_sum, entry.existence}) writer.put(sum);
  }
}

void ObjectDatabase::get(ByteReader& reader) {
  next_id_ = reader.get<std::uint64_t>();
  entries_.assign(reader.get_count(kObjectBytes), {});
  std::uint64_t last_id = 0;
  for (Entry& entry : entries_) {
    entry.object.id = reader.get<std::uint64_t>();
    entry.object.label = reader.get_text();
    entry.object.observations = reader.get<std::uint32_t>();
    entry.object.first_seen_ns = reader.get<std::int64_t>();
    entry.object.last_seen_ns = reader.get<std::int64_t>();
    entry.object.movable = reader.get<std::uint8_t>() != 0;
    entry.min = map_file::get_vector(reader);
    entry.max = map_file::get_vector(reader);
    for (double* sum : {&entry.weight, &entry.score_sum, &entry.existence}) *sum = reader.get<double>();
    const bool possible = entry.object.id > last_id && entry.object.id < next_id_ &&
                          entry.object.observations > 0 && entry.weight > 0 &&
                          (entry.min.array() <= entry.max.array()).all();
    if (!possible) reader.refuse(fmt::format("object {} with impossible values", entry.object.id));
    if (!reader.ok()) return entries_.clear();
    last_id = entry.object.id;
    describe(entry);
  }
}

map_file::Bytes SemanticMapper::to_bytes() const {
  ByteWriter writer;
  put(writer, labels_);
  map_file::put(writer, up_in_map());
  map_->octree.put(writer);
  map_->objects.put(writer);
  return writer.take();
}

tl::expected<void, std::string> SemanticMapper::start_from(std::span<const std::uint8_t> bytes) {
  ByteReader reader(bytes);
  Start start{std::make_shared<Map>(empty_map()), get_labels(reader), map_file::get_vector(reader),
              map_file::checksum_of(bytes)};
  if (reader.ok() && std::abs(start.up->norm() - 1) > 1e-6)
    reader.refuse("an upward direction that is no unit vector");
  start.map->octree.get(reader, start.labels.names().size());
  start.map->objects.get(reader);
  if (auto read = reader.finish(); !read) return read;
  go_on_from(std::move(start));
  return {};
}

tl::expected<SavedTree, std::string> tree_from_map_bytes(std::span<const std::uint8_t> bytes) {
  ByteReader reader(bytes);
  SavedTree saved;
  saved.labels = get_labels(reader).names();
  map_file::get_vector(reader);
  const auto resolution = reader.get<double>();
  const auto nodes = reader.get_bytes(reader.get_count(1));
  if (!reader.ok()) return tl::unexpected(reader.finish().error());
  auto tree = tree_from_bytes(nodes, resolution);
  if (!tree) return tl::unexpected(tree.error());
  saved.tree = std::move(*tree);
  return saved;
}

tl::expected<void, std::string> SemanticMapper::start_from(octomap::ColorOcTree&& tree) {
  if (std::abs(tree.getResolution() - config_.octree.resolution_m) > kSameResolution)
    return tl::unexpected(other_resolution(tree.getResolution(), config_.octree.resolution_m));
  Start start{std::make_shared<Map>(empty_map()), {}, {}, map_file::checksum_of(mapper::to_bytes(tree))};
  start.map->octree.start_from(std::move(tree));
  go_on_from(std::move(start));
  return {};
}

}  // namespace rds::mapper
