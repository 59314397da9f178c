// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/map_files.hpp"

#include <charconv>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string_view>

#include <fmt/format.h>

#include "common/geometry/trajectory.hpp"
#include "services/mapper/core/object_database.hpp"
#include "services/mapper/core/tree_bytes.hpp"

namespace rds::mapper {
namespace {

namespace fs = std::filesystem;
constexpr std::string_view kMagic = "# Octomap OcTree file";
constexpr std::string_view kDataLine = "\ndata\n";

WriteResult write_whole(const fs::path& file, std::span<const char> content) {
  fs::path partial = file;
  partial += ".partial";
  std::ofstream out(partial, std::ios::binary);
  out.write(content.data(), static_cast<std::streamsize>(content.size()));
  out.close();
  std::error_code error;
  if (out) fs::rename(partial, file, error);
  if (out && !error) return {};
  fs::remove(partial, error);
  return tl::unexpected(fmt::format("{}: cannot be written", file.string()));
}

/// Value of "key value" among the header's lines; empty if absent.
std::string_view header_value(std::string_view header, std::string_view key) {
  const std::string start = fmt::format("\n{} ", key);
  const auto at = header.find(start);
  if (at == std::string_view::npos) return {};
  const auto begin = at + start.size();
  return header.substr(begin, header.find('\n', begin) - begin);
}

}  // namespace

WriteResult write_tree(const fs::path& file, const octomap::ColorOcTree& tree) {
  std::ostringstream header;  // the header that octomap::AbstractOcTree::write makes
  header << kMagic << "\n# (feel free to add / change comments, but leave the first line as it is!)\n#\n"
         << "id " << tree.getTreeType() << "\nsize " << tree.size() << "\nres " << tree.getResolution()
         << kDataLine;
  const std::string head = header.str();
  const auto nodes = to_bytes(tree);
  std::vector<char> content(head.begin(), head.end());
  content.insert(content.end(), nodes.begin(), nodes.end());
  return write_whole(file, content);
}

tl::expected<std::unique_ptr<octomap::ColorOcTree>, std::string> read_tree(const fs::path& file) {
  const auto refuse = [&](const std::string& why) {
    return tl::unexpected(fmt::format("{}: {}", file.string(), why));
  };
  std::error_code error;
  std::ifstream in(file, std::ios::binary);
  if (!in || fs::is_directory(file, error)) return refuse("cannot be read, expected a saved map (map.ot)");
  const std::vector<char> content{std::istreambuf_iterator<char>(in), {}};
  const std::string_view all(content.data(), content.size());
  const auto data = all.find(kDataLine);
  if (!all.starts_with(kMagic) || data == std::string_view::npos) return refuse("is not an OctoMap .ot file");
  const auto header = all.substr(0, data + 1);
  if (header_value(header, "id") != "ColorOcTree")
    return refuse(fmt::format("holds a tree of type '{}', expected ColorOcTree", header_value(header, "id")));
  const auto text = header_value(header, "res");
  double resolution = 0;
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), resolution);
  if (parsed.ec != std::errc{})
    return refuse("has no resolution in its header, expected a line 'res METRES'");
  const auto nodes = all.substr(data + kDataLine.size());
  auto tree =
      tree_from_bytes({reinterpret_cast<const std::uint8_t*>(nodes.data()), nodes.size()}, resolution);
  if (!tree) return refuse("is damaged: " + tree.error());
  return tree;
}

bool looks_like_tree(const fs::path& file) {
  std::string start(kMagic.size(), ' ');
  std::ifstream in(file, std::ios::binary);
  in.read(start.data(), static_cast<std::streamsize>(start.size()));
  return in && start == kMagic;
}

WriteResult write_objects(const fs::path& file, std::span<const MapObject> objects) {
  return write_whole(file, to_json(objects));
}

WriteResult write_grid(const fs::path& folder, const OccupancyGrid& grid) {
  if (auto image = write_whole(folder / "grid.pgm", to_pgm(grid)); !image) return image;
  return write_whole(folder / "grid.yaml", to_map_server_yaml(grid, "grid.pgm"));
}

WriteResult write_keyframes(const fs::path& file, std::span<const KeyframePose> poses) {
  std::vector<geometry::StampedPose> stamped;
  for (const auto& pose : poses) stamped.push_back({pose.stamp_ns, pose.map_from_camera, {}});
  return geometry::write_trajectory(file, stamped);
}

}  // namespace rds::mapper
