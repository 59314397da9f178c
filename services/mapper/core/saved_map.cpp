// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/saved_map.hpp"

#include <cmath>

#include "common/map_file/checksum.hpp"
#include "common/map_file/geometry_bytes.hpp"
#include "services/mapper/core/octree/tree_bytes.hpp"

namespace rds::mapper {

map_file::Bytes to_bytes(const SemanticMap& map, const Eigen::Vector3d& up) {
  map_file::ByteWriter writer;
  map.labels.put(writer);
  map_file::put(writer, up);
  map.content->octree.put(writer);
  map.content->objects.put(writer);
  return writer.take();
}

ReadMap saved_map_from(std::span<const std::uint8_t> bytes, const MapperConfig& config) {
  map_file::ByteReader reader(bytes);
  SavedMap saved{std::make_shared<Map>(config), LabelTable::get(reader), map_file::get_vector(reader),
                 map_file::checksum_of(bytes)};
  if (reader.ok() && std::abs(saved.up->norm() - 1) > 1e-6)
    reader.refuse("an upward direction that is no unit vector");
  saved.map->octree.get(reader, saved.labels.names().size());
  saved.map->objects.get(reader);
  if (auto read = reader.finish(); !read) return tl::unexpected(read.error());
  add_saved_surfaces(*saved.map);
  return saved;
}

ReadMap saved_map_from(octomap::ColorOcTree&& tree, const MapperConfig& config) {
  SavedMap saved{std::make_shared<Map>(config), {}, {}, map_file::checksum_of(to_bytes(tree))};
  if (auto fits = saved.map->octree.start_from(std::move(tree)); !fits) return tl::unexpected(fits.error());
  add_saved_surfaces(*saved.map);
  return saved;
}

}  // namespace rds::mapper
