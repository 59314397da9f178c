// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/io/octomap_file.hpp"

#include <charconv>

#include <fmt/format.h>

#include "services/mapper/core/octree/tree_bytes.hpp"

namespace rds::mapper {
namespace {

constexpr std::string_view kFullMagic = "# Octomap OcTree file";
constexpr std::string_view kBinaryMagic = "# Octomap OcTree binary file";
static_assert(kBinaryMagic.size() == kOctomapStartBytes);
constexpr std::string_view kDataLine = "\ndata\n";

/// Value of "key value" among the header's lines; empty if absent.
std::string_view header_value(std::string_view header, std::string_view key) {
  const std::string start = fmt::format("\n{} ", key);
  const auto at = header.find(start);
  if (at == std::string_view::npos) return {};
  const auto begin = at + start.size();
  return header.substr(begin, header.find('\n', begin) - begin);
}

}  // namespace

bool starts_as_binary_octomap_file(std::string_view content) {
  return content.starts_with(kBinaryMagic);
}

bool starts_as_octomap_file(std::string_view content) {
  return content.starts_with(kFullMagic) || starts_as_binary_octomap_file(content);
}

tl::expected<std::unique_ptr<octomap::ColorOcTree>, std::string> tree_from_octomap_file(
    std::span<const std::uint8_t> content) {
  const std::string_view all(reinterpret_cast<const char*>(content.data()), content.size());
  const auto data = all.find(kDataLine);
  if (!starts_as_octomap_file(all) || data == std::string_view::npos)
    return tl::unexpected<std::string>("is not an OctoMap .ot or .bt file");
  const bool is_binary = starts_as_binary_octomap_file(all);
  const auto header = all.substr(0, data + 1);
  if (!is_binary && header_value(header, "id") != "ColorOcTree")
    return tl::unexpected(
        fmt::format("holds a tree of type '{}', expected ColorOcTree", header_value(header, "id")));
  const auto text = header_value(header, "res");
  double resolution_m = 0;
  if (std::from_chars(text.data(), text.data() + text.size(), resolution_m).ec != std::errc{})
    return tl::unexpected<std::string>("has no resolution in its header, expected a line 'res METRES'");
  const auto nodes = content.subspan(data + kDataLine.size());
  auto tree = is_binary ? tree_from_binary_bytes(nodes, resolution_m) : tree_from_bytes(nodes, resolution_m);
  if (!tree) return tl::unexpected("is damaged: " + tree.error());
  return tree;
}

}  // namespace rds::mapper
