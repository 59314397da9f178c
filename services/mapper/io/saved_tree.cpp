// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/io/saved_tree.hpp"

#include "common/map_file/byte_reader.hpp"
#include "common/map_file/geometry_bytes.hpp"
#include "services/mapper/core/octree/label_table.hpp"
#include "services/mapper/core/octree/tree_bytes.hpp"

namespace rds::mapper {

tl::expected<SavedTree, std::string> tree_from_map_bytes(std::span<const std::uint8_t> bytes) {
  map_file::ByteReader reader(bytes);
  SavedTree saved;
  saved.labels = LabelTable::get(reader).names();
  map_file::get_vector(reader);
  const auto resolution = reader.get<double>();
  const auto nodes = reader.get_bytes(reader.get_count(1));
  if (!reader.ok()) return tl::unexpected(reader.finish().error());
  auto tree = tree_from_bytes(nodes, resolution);
  if (!tree) return tl::unexpected(tree.error());
  saved.tree = std::move(*tree);
  return saved;
}

}  // namespace rds::mapper
