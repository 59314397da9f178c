// SPDX-License-Identifier: Apache-2.0
#include "tools/evaluation/octree_file.hpp"

#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>

#include <fmt/format.h>

namespace rds::evaluation {
namespace {
constexpr int kLevels = 16;
constexpr int kHighestOccupiedLeaf = 6;
constexpr int kKeyOfOrigin = 32768;
constexpr std::size_t kValueBytes = sizeof(float);
constexpr std::size_t kColorBytes = 3;
constexpr std::string_view kFirstLine = "# Octomap OcTree file";
constexpr std::string_view kDataLine = "\ndata\n";

struct PendingNode {
  std::array<std::uint16_t, 3> key;
  int height;
};

/// The header's fields; the nodes follow at `data`.
struct Header {
  OctreeFile tree;
  std::size_t data = 0;
};

std::optional<Header> parse_header(const std::string& bytes) {
  const std::size_t end = bytes.find(kDataLine);
  if (!bytes.starts_with(kFirstLine) || end == std::string::npos) return std::nullopt;
  Header header;
  header.data = end + kDataLine.size();
  std::istringstream lines(bytes.substr(0, end));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string key;
    words >> key;
    if (key == "id") words >> header.tree.type;
    if (key == "res") words >> header.tree.resolution_m;
  }
  const bool known = header.tree.type == "OcTree" || header.tree.type == "ColorOcTree";
  if (!known || !(header.tree.resolution_m > 0) || !std::isfinite(header.tree.resolution_m))
    return std::nullopt;
  return header;
}

/// Node by node, depth first: value, colour, a bit per child; children in ascending order follow.
bool parse_nodes(const std::string& bytes, std::size_t at, OctreeFile& tree) {
  const std::size_t record = kValueBytes + (tree.type == "ColorOcTree" ? kColorBytes : 0);
  std::vector<PendingNode> pending{{{0, 0, 0}, kLevels}};
  if (at == bytes.size()) pending.clear();  // an empty tree has no root
  while (!pending.empty()) {
    const PendingNode node = pending.back();
    pending.pop_back();
    if (at + record + 1 > bytes.size()) return false;
    float log_odds = 0;
    std::memcpy(&log_odds, bytes.data() + at, kValueBytes);
    const char* color = bytes.data() + at + kValueBytes;
    const auto children = static_cast<std::uint8_t>(bytes[at + record]);
    at += record + 1;
    ++tree.nodes;
    if (children == 0) {
      OctreeLeaf& leaf = tree.leaves.emplace_back(OctreeLeaf{node.key, node.height, log_odds, {}});
      if (record > kValueBytes) std::memcpy(leaf.color.data(), color, kColorBytes);
      continue;
    }
    if (node.height == 0) return false;
    const auto side = static_cast<unsigned>(1U << (node.height - 1));
    for (int child = 7; child >= 0; --child) {
      if ((children >> child & 1) == 0) continue;
      PendingNode next{node.key, node.height - 1};
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (child >> axis & 1) next.key[axis] = static_cast<std::uint16_t>(next.key[axis] + side);
      pending.push_back(next);
    }
  }
  return at == bytes.size();
}

}  // namespace

std::vector<Eigen::Vector3d> OctreeFile::occupied_centers() const {
  std::vector<Eigen::Vector3d> centers;
  for (const auto& leaf : leaves) {
    if (!(leaf.log_odds > 0)) continue;
    const int side = 1 << leaf.height;
    for (int x = 0; x < side; ++x)
      for (int y = 0; y < side; ++y)
        for (int z = 0; z < side; ++z) {
          const Eigen::Vector3d corner(leaf.key[0] + x, leaf.key[1] + y, leaf.key[2] + z);
          centers.emplace_back((corner.array() - kKeyOfOrigin + 0.5) * resolution_m);
        }
  }
  return centers;
}

std::vector<std::array<std::uint8_t, 3>> OctreeFile::occupied_colors() const {
  std::vector<std::array<std::uint8_t, 3>> colors;
  for (const auto& leaf : leaves)
    if (leaf.log_odds > 0) colors.insert(colors.end(), std::size_t{1} << (3 * leaf.height), leaf.color);
  return colors;
}

tl::expected<OctreeFile, std::string> read_octree_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in || std::filesystem::is_directory(file))
    return tl::unexpected(fmt::format("{}: cannot be read, expected an OctoMap .ot file", file.string()));
  const std::string bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  auto header = parse_header(bytes);
  if (!header)
    return tl::unexpected(
        fmt::format("{}: no OctoMap .ot file, expected `{}`, id OcTree or ColorOcTree, res > 0",
                    file.string(), kFirstLine));
  if (!parse_nodes(bytes, header->data, header->tree))
    return tl::unexpected(fmt::format("{}: torn after node {}, expected whole nodes to the file's end",
                                      file.string(), header->tree.nodes));
  for (const auto& leaf : header->tree.leaves)
    if (leaf.log_odds > 0 && leaf.height > kHighestOccupiedLeaf)
      return tl::unexpected(fmt::format("{}: an occupied leaf of {:.1f} m a side, expected at most 64 voxels",
                                        file.string(), std::ldexp(header->tree.resolution_m, leaf.height)));
  return std::move(header->tree);
}

}  // namespace rds::evaluation
