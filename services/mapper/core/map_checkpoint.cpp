// SPDX-License-Identifier: Apache-2.0
// What of the map outlasts the process, and the map made of that again.
#include <algorithm>

#include "common/map_file/geometry_bytes.hpp"
#include "services/mapper/core/semantic_mapper.hpp"

namespace rds::mapper {
namespace {

using map_file::ByteReader;
using map_file::ByteWriter;

constexpr std::size_t kMaxUnsavedFinal = 100;  // then the final map, which is large, is saved again
constexpr std::size_t kKeyframeBytes = 8 + 8 + 96;
constexpr double kBytesPerMb = 1e6;

bool begins_with(const LabelTable& labels, const LabelTable& first) {
  return labels.names().size() >= first.names().size() &&
         std::ranges::equal(first.names(), std::span(labels.names()).first(first.names().size()));
}

bool has_labels_below(const KeyframeRecord& record, std::size_t labels) {
  const auto is_below = [&](std::uint16_t label) { return label < labels; };
  return std::ranges::all_of(record.labels, is_below) &&
         std::ranges::all_of(record.sightings, is_below, &ObjectSighting::label);
}

}  // namespace

map_file::Bytes SemanticMapper::final_map_bytes() const {
  ByteWriter writer;
  base_->octree.put(writer);
  base_->objects.put(writer);
  return writer.take();
}

std::optional<MapCheckpoint> SemanticMapper::checkpoint() {
  if (!records_.save()) return std::nullopt;
  MapCheckpoint checkpoint;
  const bool changed = !has_checkpoint_ && base_;
  if (changed || unsaved_final_.size() >= kMaxUnsavedFinal) {
    checkpoint.final_map = final_map_bytes();
    for (const auto& [id, keyframe] : unsaved_final_) records_.drop(id);
    unsaved_final_.clear();
  }
  has_checkpoint_ = true;
  ByteWriter state;
  state.put(map_epoch_);
  state.put(start_.checksum);
  state.put_count(final_keyframes_ - unsaved_final_.size());
  labels_.put(state);
  checkpoint.state = state.take();
  std::map<std::uint64_t, ByteWriter> blocks;
  for (const auto* keyframes : {&unsaved_final_, &keyframes_})
    for (const auto& [id, keyframe] : *keyframes) {
      ByteWriter& block = blocks[id / MapCheckpoint::kIdsPerBlock];
      block.put(id);
      block.put(keyframe.stamp_ns);
      map_file::put(block, keyframe.pose);
    }
  for (auto& [block, writer] : blocks) checkpoint.keyframes[block] = writer.take();
  return checkpoint;
}

tl::expected<void, std::string> SemanticMapper::restore(const MapCheckpoint& checkpoint) {
  ByteReader state(checkpoint.state);
  const auto epoch = state.get<std::uint64_t>();
  const auto began_with = state.get<std::uint64_t>();
  if (start_.map && began_with != start_.checksum) state.refuse("a map that began with another saved map");
  const auto final_keyframes = state.get<std::uint64_t>();
  LabelTable labels = LabelTable::get(state);
  if (!begins_with(labels, start_.labels)) state.refuse("labels other than the saved map's");
  if (auto read = state.finish(); !read) return read;
  auto base = start_.map;
  if (checkpoint.final_map) {
    ByteReader reader(*checkpoint.final_map);
    base = std::make_shared<Map>(config_);
    base->octree.get(reader, labels.names().size());
    base->objects.get(reader);
    if (auto read = reader.finish(); !read) return read;
    know_surfaces(*base);
  }
  std::map<std::uint64_t, Keyframe> keyframes;
  for (const auto& [block, bytes] : checkpoint.keyframes) {
    ByteReader reader(bytes);
    for (std::size_t i = 0; i < bytes.size() / kKeyframeBytes; ++i) {
      const auto id = reader.get<std::uint64_t>();
      const auto stamp_ns = reader.get<std::int64_t>();
      const auto pose = map_file::get_pose(reader);
      keyframes[id] = {stamp_ns, stamp_ns, pose, pose};  // times follow with the rebuild
    }
    if (auto read = reader.finish(); !read) return read;
  }
  map_epoch_ = epoch;
  labels_ = std::move(labels);
  base_ = std::move(base);
  final_keyframes_ = final_keyframes;
  keyframes_ = std::move(keyframes);
  take_over_records();
  rebuild();
  has_checkpoint_ = true;
  keep_within_limits();
  return {};
}

/// The storage's records of the keyframes; in memory no more than fit there.
void SemanticMapper::take_over_records() {
  std::vector<std::uint64_t> lost;
  for (const auto& [id, keyframe] : keyframes_) {
    const auto record = records_.adopt(id);
    if (!record || !has_labels_below(*record, labels_.names().size())) lost.push_back(id);
    const double limit = config_.correction.memory_mb * kBytesPerMb;
    while (static_cast<double>(records_.bytes_in_memory()) > limit && records_.in_memory() > 1)
      if (!records_.spill_oldest()) break;
  }
  for (const auto id : lost) lose(id);
}

}  // namespace rds::mapper
