// SPDX-License-Identifier: Apache-2.0
// The map as bytes and back: what of each part cannot be computed again.
#include <cmath>

#include "common/map_file/checksum.hpp"
#include "common/map_file/geometry_bytes.hpp"
#include "services/mapper/core/octree/tree_bytes.hpp"
#include "services/mapper/core/semantic_mapper.hpp"

namespace rds::mapper {
namespace {

using map_file::ByteReader;
using map_file::ByteWriter;

}  // namespace

map_file::Bytes SemanticMapper::to_bytes() const {
  ByteWriter writer;
  labels_.put(writer);
  map_file::put(writer, up_in_map());
  map_->octree.put(writer);
  map_->objects.put(writer);
  return writer.take();
}

tl::expected<void, std::string> SemanticMapper::start_from(std::span<const std::uint8_t> bytes) {
  ByteReader reader(bytes);
  SavedMap saved{std::make_shared<Map>(config_), LabelTable::get(reader), map_file::get_vector(reader),
                 map_file::checksum_of(bytes)};
  if (reader.ok() && std::abs(saved.up->norm() - 1) > 1e-6)
    reader.refuse("an upward direction that is no unit vector");
  saved.map->octree.get(reader, saved.labels.names().size());
  saved.map->objects.get(reader);
  if (auto read = reader.finish(); !read) return read;
  go_on_from(std::move(saved));
  return {};
}

tl::expected<void, std::string> SemanticMapper::start_from(octomap::ColorOcTree&& tree) {
  SavedMap saved{std::make_shared<Map>(config_), {}, {}, map_file::checksum_of(mapper::to_bytes(tree))};
  if (auto fits = saved.map->octree.start_from(std::move(tree)); !fits) return fits;
  go_on_from(std::move(saved));
  return {};
}

}  // namespace rds::mapper
