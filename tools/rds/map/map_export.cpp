// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/map/map_export.hpp"

#include <algorithm>
#include <sstream>
#include <vector>

#include <fmt/format.h>

#include "common/map_file/atomic_file.hpp"
#include "services/mapper/core/octree/label_table.hpp"
#include "services/mapper/core/octree/tree_bytes.hpp"
#include "services/mapper/core/segmentation/gravity.hpp"
#include "services/mapper/io/map_files.hpp"

namespace rds::tools {
namespace {
using octomap::ColorOcTree;
using octomap::ColorOcTreeNode;
using Result = tl::expected<void, std::string>;

bool is_occupied(const ColorOcTreeNode& node) {
  return node.getLogOdds() > 0;
}

/// True if the tree has a voxel for the point; false for NaN.
bool is_inside(const ColorOcTree& tree, const Eigen::Vector3d& point) {
  constexpr double kHalfWidthVoxels = 32767;  // 16 levels, and one voxel for rounding
  return (point.array().abs() <= kHalfWidthVoxels * tree.getResolution()).all();
}

/// Voxels at the finest resolution inside a leaf.
double voxels_of(const ColorOcTree& tree, const ColorOcTree::leaf_iterator& leaf) {
  const double side = 1U << (tree.getTreeDepth() - leaf.getDepth());
  return side * side * side;
}

/// Sum of x + y + z over the keys of the voxels inside a leaf.
std::uint64_t key_sum_of(const ColorOcTree& tree, const ColorOcTree::leaf_iterator& leaf) {
  const std::uint64_t side = std::uint64_t{1} << (tree.getTreeDepth() - leaf.getDepth());
  const octomap::OcTreeKey first = leaf.getIndexKey();
  return side * side * side * (first[0] + first[1] + first[2]) + 3 * side * side * side * (side - 1) / 2;
}

std::vector<ColoredPoint> occupied_points(const ColorOcTree& tree) {
  std::vector<ColoredPoint> points;
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    if (!is_occupied(*leaf)) continue;
    const auto color = leaf->getColor();
    points.push_back(
        {Eigen::Vector3d(leaf.getX(), leaf.getY(), leaf.getZ()).cast<float>(), {color.r, color.g, color.b}});
  }
  return points;
}

std::string to_pcd(std::span<const ColoredPoint> points) {
  std::string pcd = fmt::format(
      "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH {0}\n"
      "HEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {0}\nDATA binary\n",
      points.size());
  for (const ColoredPoint& point : points) {
    const auto rgb = static_cast<std::uint32_t>(point.rgb[0] << 16 | point.rgb[1] << 8 | point.rgb[2]);
    pcd.append(reinterpret_cast<const char*>(point.center.data()), 12);
    pcd.append(reinterpret_cast<const char*>(&rgb), 4);
  }
  return pcd;
}

/// Nodes of the tree that binary bytes describe: the root, and two bits that are not 0 for every other.
std::size_t count_nodes(std::span<const std::uint8_t> bytes) {
  std::size_t nodes = bytes.empty() ? 0 : 1;
  for (const std::uint8_t byte : bytes)
    for (int shift = 0; shift < 8; shift += 2) nodes += (byte >> shift & 3) != 0 ? 1U : 0U;
  return nodes;
}

std::string to_bt(const ColorOcTree& tree) {
  std::ostringstream out;  // the header that octomap::AbstractOccupancyOcTree::writeBinary makes
  const auto nodes = mapper::to_binary_bytes(tree);
  out << "# Octomap OcTree binary file\n# (feel free to add / change comments, but leave the first line as "
         "it is!)\n#\n"
      << "id OcTree\nsize " << count_nodes(nodes) << "\nres " << tree.getResolution() << "\ndata\n"
      << std::string(nodes.begin(), nodes.end());
  return out.str();
}

Result write_pgm(const ColorOcTree& tree, const std::filesystem::path& file, const std::string& up) {
  const auto grid = mapper::make_grid(tree, mapper::axis_of(up), mapper::GridConfig());
  auto yaml = file;
  yaml.replace_extension(".yaml");
  if (auto written = map_file::write_atomically(file, mapper::to_pgm(grid)); !written) return written;
  return map_file::write_atomically(yaml, mapper::to_map_server_yaml(grid, file.filename().string()));
}

}  // namespace

std::string to_ply(std::span<const ColoredPoint> points, const std::string& comment) {
  std::string ply = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment {}\nelement vertex {}\n"
      "property float x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n",
      comment, points.size());
  for (const ColoredPoint& point : points) {
    ply.append(reinterpret_cast<const char*>(point.center.data()), 12);
    ply.append(reinterpret_cast<const char*>(point.rgb.data()), 3);
  }
  return ply;
}

std::string format_of(const std::filesystem::path& file) {
  const std::string ending = file.extension().string();
  for (const char* format : kMapFormats)
    if (ending == std::string(".") + format) return format;
  return "";
}

Result export_map(const ColorOcTree& tree, const std::string& format, const std::filesystem::path& file,
                  const std::string& up) {
  if (format == "ot") return mapper::write_tree(file, tree);
  if (format == "bt") return map_file::write_atomically(file, to_bt(tree));
  if (format == "ply")
    return map_file::write_atomically(
        file, to_ply(occupied_points(tree), fmt::format("occupied voxels of {} m", tree.getResolution())));
  if (format == "pcd") return map_file::write_atomically(file, to_pcd(occupied_points(tree)));
  if (format == "pgm") return write_pgm(tree, file, up);
  return tl::unexpected(fmt::format("{}: format '{}', expected one of {}", file.string(), format,
                                    fmt::join(std::begin(kMapFormats), std::end(kMapFormats), ", ")));
}

nlohmann::ordered_json describe_map(const ColorOcTree& tree) {
  double occupied = 0;
  double free = 0;
  std::size_t leaves = 0;
  std::uint64_t key_sum = 0;
  Eigen::Array3d low = Eigen::Array3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Array3d high = -low;
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    ++leaves;
    (is_occupied(*leaf) ? occupied : free) += voxels_of(tree, leaf);
    if (!is_occupied(*leaf)) continue;
    key_sum += key_sum_of(tree, leaf);
    const Eigen::Array3d center(leaf.getX(), leaf.getY(), leaf.getZ());
    low = low.min(center - leaf.getSize() / 2);
    high = high.max(center + leaf.getSize() / 2);
  }
  const double voxel_m = tree.getResolution();
  nlohmann::ordered_json json{{"type", tree.getTreeType()},
                              {"resolution", voxel_m},
                              {"nodes", tree.size()},
                              {"leaves", leaves},
                              {"occupied_voxels", static_cast<std::uint64_t>(occupied)},
                              {"free_voxels", static_cast<std::uint64_t>(free)},
                              {"occupied_key_sum", key_sum},
                              {"occupied_m3", occupied * voxel_m * voxel_m * voxel_m}};
  if (occupied > 0) {
    json["bounds_min"] = {low.x(), low.y(), low.z()};
    json["bounds_max"] = {high.x(), high.y(), high.z()};
  }
  return json;
}

nlohmann::ordered_json query_map(const ColorOcTree& tree, const Eigen::Vector3d& point,
                                 std::span<const std::string> labels) {
  nlohmann::ordered_json json{{"point", {point.x(), point.y(), point.z()}}};
  const ColorOcTreeNode* node =
      is_inside(tree, point) ? tree.search(point.x(), point.y(), point.z()) : nullptr;
  if (node == nullptr) {
    json["state"] = "unknown";
    return json;
  }
  const auto color = node->getColor();
  const mapper::Rgb rgb{color.r, color.g, color.b};
  json["state"] = is_occupied(*node) ? "occupied" : "free";
  json["probability"] = node->getOccupancy();
  json["color"] = rgb;
  const auto label = std::ranges::find_if(
      labels, [&](const std::string& name) { return !name.empty() && mapper::label_color(name) == rgb; });
  if (label != labels.end()) json["label"] = *label;
  return json;
}

}  // namespace rds::tools
