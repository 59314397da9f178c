// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/io/map_files.hpp"

#include <sstream>

#include <fmt/format.h>

#include "common/geometry/trajectory.hpp"
#include "common/map_file/atomic_file.hpp"
#include "services/mapper/io/octomap_file.hpp"
#include "services/mapper/core/objects/object_database.hpp"
#include "services/mapper/core/octree/tree_bytes.hpp"

namespace rds::mapper {
namespace {

namespace fs = std::filesystem;
using map_file::write_atomically;

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

WriteResult write_tree(const fs::path& file, const octomap::ColorOcTree& tree) {
  return write_atomically(file, to_octomap_file(tree));
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

WriteResult write_objects(const fs::path& file, std::span<const MapObject> objects) {
  return write_atomically(file, to_json(objects));
}

WriteResult write_grid(const fs::path& folder, const OccupancyGrid& grid) {
  if (auto image = write_atomically(folder / "grid.pgm", to_pgm(grid)); !image) return image;
  return write_atomically(folder / "grid.yaml", to_map_server_yaml(grid, "grid.pgm"));
}

WriteResult write_keyframes(const fs::path& file, std::span<const geometry::KeyframePose> poses) {
  std::vector<geometry::StampedPose> stamped;
  for (const auto& pose : poses) stamped.push_back({pose.stamp_ns, pose.map_from_camera, {}});
  return geometry::write_trajectory(file, stamped);
}

}  // namespace rds::mapper
