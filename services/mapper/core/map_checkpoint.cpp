// SPDX-License-Identifier: Apache-2.0
// What of the map outlasts the process, and the map made of that again.
#include <algorithm>

#include "services/mapper/core/semantic_mapper.hpp"

namespace rds::mapper {
namespace {

using map_file::ByteReader;
using map_file::ByteWriter;

bool begins_with(const LabelTable& labels, const LabelTable& first) {
  return labels.names().size() >= first.names().size() &&
         std::ranges::equal(first.names(), std::span(labels.names()).first(first.names().size()));
}

}  // namespace

std::optional<MapCheckpoint> SemanticMapper::checkpoint() {
  auto archive = archive_.save(base_ != nullptr);
  if (!archive) return std::nullopt;
  MapCheckpoint checkpoint;
  if (archive->needs_final_map) {
    ByteWriter final_map;
    base_->octree.put(final_map);
    base_->objects.put(final_map);
    checkpoint.final_map = final_map.take();
  }
  ByteWriter state;
  state.put(map_.epoch);
  state.put(saved_.checksum);
  state.put_count(archive->saved_final);
  map_.labels.put(state);
  checkpoint.state = state.take();
  checkpoint.keyframes = std::move(archive->keyframes);
  return checkpoint;
}

tl::expected<void, std::string> SemanticMapper::restore(const MapCheckpoint& checkpoint) {
  ByteReader state(checkpoint.state);
  const auto epoch = state.get<std::uint64_t>();
  const auto began_with = state.get<std::uint64_t>();
  if (saved_.map && began_with != saved_.checksum) state.refuse("a map that began with another saved map");
  const auto final_keyframes = state.get<std::uint64_t>();
  LabelTable labels = LabelTable::get(state);
  if (!begins_with(labels, saved_.labels)) state.refuse("labels other than the saved map's");
  if (auto read = state.finish(); !read) return read;
  auto base = saved_.map;
  if (checkpoint.final_map) {
    ByteReader reader(*checkpoint.final_map);
    base = std::make_shared<Map>(config_);
    base->octree.get(reader, labels.names().size());
    base->objects.get(reader);
    if (auto read = reader.finish(); !read) return read;
    add_saved_surfaces(*base);
  }
  auto keyframes = KeyframeArchive::from_blocks(checkpoint.keyframes);
  if (!keyframes) return tl::unexpected(keyframes.error());
  map_.epoch = epoch;
  map_.labels = std::move(labels);
  base_ = std::move(base);
  archive_.restore(std::move(*keyframes), final_keyframes, map_.labels.names().size());
  rebuild();
  while (const auto id = archive_.spill()) make_final(*id);
  return {};
}

}  // namespace rds::mapper
