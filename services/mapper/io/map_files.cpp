// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/io/map_files.hpp"

#include <sstream>

#include <fmt/format.h>

#include "common/map_file/atomic_file.hpp"
#include "common/map_file/byte_reader.hpp"
#include "common/map_file/geometry_bytes.hpp"
#include "services/mapper/core/objects/object_json.hpp"
#include "services/mapper/core/octree/label_table.hpp"
#include "services/mapper/core/octree/tree_bytes.hpp"
#include "services/mapper/io/octomap_file.hpp"

namespace rds::mapper {
namespace {

namespace fs = std::filesystem;

map_file::Bytes bytes_of(const std::string& text) {
  return {text.begin(), text.end()};
}

/// A tree as OctoMap's file.
map_file::Bytes to_octomap_file(const octomap::ColorOcTree& tree) {
  std::ostringstream header;  // the header that octomap::AbstractOcTree::write makes
  header << "# Octomap OcTree file\n# (feel free to add / change comments, but leave the first line as it "
            "is!)\n#\n"
         << "id " << tree.getTreeType() << "\nsize " << tree.size() << "\nres " << tree.getResolution()
         << "\ndata\n";
  map_file::Bytes content = bytes_of(header.str());
  const auto nodes = to_bytes(tree);
  content.insert(content.end(), nodes.begin(), nodes.end());
  return content;
}

}  // namespace

std::map<std::string, map_file::Bytes> files_for_others(const octomap::ColorOcTree& tree,
                                                        std::span<const MapObject> objects,
                                                        const OccupancyGrid& grid) {
  return {{kTreeFile, to_octomap_file(tree)},
          {"objects.json", bytes_of(to_json(objects))},
          {"grid.pgm", bytes_of(to_pgm(grid))},
          {"grid.yaml", bytes_of(to_map_server_yaml(grid, "grid.pgm"))}};
}

tl::expected<void, std::string> write_tree(const fs::path& file, const octomap::ColorOcTree& tree) {
  return map_file::write_atomically(file, to_octomap_file(tree));
}

tl::expected<std::unique_ptr<octomap::ColorOcTree>, std::string> read_tree(
    const fs::path& file, const map_file::FileLimits& limits) {
  const auto content = map_file::read_regular_file(file, limits);
  if (!content)
    return tl::unexpected(
        fmt::format("{}: cannot be read, expected a saved map (map.ot): {}", file.string(), content.error()));
  auto tree = tree_from_octomap_file(*content);
  if (!tree) return tl::unexpected(fmt::format("{}: {}", file.string(), tree.error()));
  return tree;
}

bool looks_like_tree(const fs::path& file) {
  return starts_as_octomap_file(map_file::start_of_file(file, kOctomapStartBytes));
}

bool looks_like_binary_tree(const fs::path& file) {
  return starts_as_binary_octomap_file(map_file::start_of_file(file, kOctomapStartBytes));
}

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
