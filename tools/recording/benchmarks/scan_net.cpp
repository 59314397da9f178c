// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <fstream>
#include <iterator>

#include <fmt/format.h>

#include "common/image/picture_file.hpp"
#include "tools/recording/benchmarks/benchmarks.hpp"

namespace rds::recording {
namespace fs = std::filesystem;
namespace {

using Camera = tl::expected<geometry::CameraModel, std::string>;

/// The camera of a 4×4 matrix of intrinsics and of the size that a picture of it has.
Camera read_camera(const fs::path& intrinsics, const fs::path& picture) {
  std::ifstream in(intrinsics);
  std::array<double, 7> k{};  // row by row, as far as cy
  for (double& number : k)
    if (!(in >> number)) return tl::unexpected(fmt::format("{}: expected a 4×4 matrix", intrinsics.string()));
  std::ifstream file(picture, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
  const cv::Size size =
      image::declared_size({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  if (size.empty()) return tl::unexpected(fmt::format("{}: expected a picture", picture.string()));
  return geometry::CameraModel{
      .width = size.width, .height = size.height, .fx = k[0], .fy = k[5], .cx = k[2], .cy = k[6]};
}

}  // namespace

std::optional<OpenedBenchmark> open_scan_net(const fs::path& folder) {
  std::error_code error;
  const fs::path intrinsics = folder / "intrinsic";
  const auto files = numbered_files(folder / "color", "", ".jpg");
  if (files.empty() || !fs::exists(intrinsics / "intrinsic_depth.txt", error)) return std::nullopt;
  std::vector<NumberedRecording::Entry> entries;
  NumberedRecording::Truth truth;
  for (const auto& [number, color] : files) {
    entries.push_back({number, color, folder / "depth" / fmt::format("{}.png", number)});
    std::ifstream pose(folder / "pose" / fmt::format("{}.txt", number));
    if (const auto world_from_camera = read_matrix(pose)) truth.emplace_back(number, *world_from_camera);
  }
  const Camera color = read_camera(intrinsics / "intrinsic_color.txt", entries.front().color);
  const Camera depth = read_camera(intrinsics / "intrinsic_depth.txt", entries.front().depth);
  if (!color || !depth) return tl::unexpected(color ? depth.error() : color.error());
  return std::make_unique<NumberedRecording>(NumberedForm{.camera = *depth, .color_camera = *color},
                                             std::move(entries), truth);
}

}  // namespace rds::recording
