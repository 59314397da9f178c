// SPDX-License-Identifier: Apache-2.0
// What of the map outlasts the process, and the map made of that again.
#include <algorithm>

#include "services/mapper/core/semantic_mapper.hpp"

namespace rds::mapper {
namespace {

using map_file::ByteReader;
using map_file::ByteWriter;

constexpr std::uint32_t kForm = 4;  // of records and final maps; who changes one raises it

bool begins_with(const LabelTable& labels, const LabelTable& first) {
  return labels.names().size() >= first.names().size() &&
         std::ranges::equal(first.names(), std::span(labels.names()).first(first.names().size()));
}

}  // namespace

std::optional<MapCheckpoint> SemanticMapper::checkpoint() {
  auto archive = archive_.save(has_final_);
  if (!archive) return std::nullopt;
  MapCheckpoint checkpoint;
  if (archive->needs_final_map) {
    ByteWriter final_map;
    map_.content->evidence.final_map().put(final_map);
    final_objects_.put(final_map);
    checkpoint.final_map = final_map.take();
  }
  ByteWriter state;
  state.put(kForm);
  state.put(map_.epoch);
  state.put(saved_.checksum);
  state.put_count(archive->saved_final);
  map_.labels.put(state);
  map_.content->objects.put_identities(state);
  checkpoint.state = state.take();
  checkpoint.keyframes = std::move(archive->keyframes);
  return checkpoint;
}

tl::expected<void, std::string> SemanticMapper::restore(const MapCheckpoint& checkpoint) {
  ByteReader state(checkpoint.state);
  if (state.get<std::uint32_t>() != kForm) state.refuse("a checkpoint of another version of the mapper");
  const auto epoch = state.get<std::uint64_t>();
  const auto began_with = state.get<std::uint64_t>();
  if (saved_.voxels && began_with != saved_.checksum) state.refuse("a map that began with another saved map");
  const auto final_keyframes = state.get<std::uint64_t>();
  LabelTable labels = LabelTable::get(state);
  if (!begins_with(labels, saved_.labels)) state.refuse("labels other than the saved map's");
  ObjectDatabase identities(config_.objects);
  identities.get_identities(state);
  if (auto read = state.finish(); !read) return read;
  std::shared_ptr<const FinalMap> voxels = saved_.voxels;
  ObjectDatabase objects = saved_.objects.value_or(ObjectDatabase(config_.objects));
  if (checkpoint.final_map) {
    ByteReader reader(*checkpoint.final_map);
    voxels = std::make_shared<const FinalMap>(FinalMap::get(reader, labels.names().size()));
    objects.get(reader);
    if (auto read = reader.finish(); !read) return read;
  }
  auto keyframes = KeyframeArchive::from_blocks(checkpoint.keyframes);
  if (!keyframes) return tl::unexpected(keyframes.error());
  map_.epoch = epoch;
  map_.labels = std::move(labels);
  map_.content = std::make_unique<Map>(config_, memory_);
  if (voxels) map_.content->evidence.begin_with(*voxels);
  map_.content->objects = final_objects_ = std::move(objects);
  are_objects_outdated_ = has_moves_left_ = false;
  has_final_ = voxels != nullptr;
  archive_.restore(std::move(*keyframes), final_keyframes, map_.labels.names().size());
  add_all(identities);
  return {};
}

/// Adds the keyframes of the archive to a map that has none of them.
/// @param identities  of its objects.
void SemanticMapper::add_all(const ObjectDatabase& identities) {
  map_.content->objects.reserve_ids_of(identities);
  object_views_.clear();
  archive_.set_times();
  std::vector<std::uint64_t> ids;
  for (const auto& [id, keyframe] : archive_.keyframes()) ids.push_back(id);
  for (const std::uint64_t id : ids) {
    progress_();
    if (const auto record = archive_.record(id))
      add(*record);
    else
      lose(id);
  }
  map_.content->objects.take_ids_from(identities);
  show(true);
  spill();
}

}  // namespace rds::mapper
