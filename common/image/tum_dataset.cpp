// SPDX-License-Identifier: Apache-2.0
#include "common/image/tum_dataset.hpp"

#include <algorithm>
#include <span>

#include <fmt/format.h>

#include "common/geometry/association.hpp"
#include "common/geometry/stamp.hpp"
#include "common/image/picture_file.hpp"

namespace rds::image {
namespace {

std::vector<std::int64_t> stamps_of(const TumList& list) {
  std::vector<std::int64_t> stamps;
  stamps.reserve(list.entries.size());
  for (const auto& entry : list.entries) stamps.push_back(entry.stamp_ns);
  return stamps;
}

}  // namespace

tl::expected<TumDataset, std::string> TumDataset::open(const std::filesystem::path& folder,
                                                       const TumDatasetOptions& options) {
  if (!std::filesystem::is_directory(folder))
    return tl::unexpected(
        fmt::format("{}: no such folder, expected a dataset with rgb.txt and depth.txt", folder.string()));
  TumDataset dataset;
  dataset.folder_ = folder;
  if (auto camera = dataset.read_camera(); !camera) return tl::unexpected(camera.error());
  auto color = read_tum_list(folder / "rgb.txt");
  if (!color) return tl::unexpected(color.error());
  auto depth = read_tum_list(folder / "depth.txt");
  if (!depth) return tl::unexpected(depth.error());
  dataset.color_ = std::move(*color);
  dataset.depth_ = std::move(*depth);
  if (auto paired = dataset.pair_frames(options); !paired) return tl::unexpected(paired.error());
  if (std::filesystem::exists(folder / "groundtruth.txt")) {
    auto truth = geometry::read_trajectory(folder / "groundtruth.txt");
    if (!truth) return tl::unexpected(truth.error());
    dataset.ground_truth_ = std::move(*truth);
  }
  return dataset;
}

tl::expected<void, std::string> TumDataset::read_camera() {
  const auto file = folder_ / "camera.yaml";
  if (std::filesystem::exists(file)) {
    auto description = read_camera_yaml(file);
    if (!description) return tl::unexpected(description.error());
    camera_ = *description;
    return {};
  }
  const auto known = tum_camera_of_folder(std::filesystem::weakly_canonical(folder_).filename().string());
  if (!known)
    return tl::unexpected(
        fmt::format("{}: no such file, expected the camera's description (or a folder named after freiburg1, "
                    "freiburg2 or freiburg3)",
                    file.string()));
  camera_ = *known;
  return {};
}

tl::expected<void, std::string> TumDataset::pair_frames(const TumDatasetOptions& options) {
  const auto color_stamps = stamps_of(color_);
  const auto depth_stamps = stamps_of(depth_);
  const auto pairs = geometry::pair_in_order(color_stamps, depth_stamps, options.pairing_tolerance_ns);
  for (const auto& color : color_.entries)
    frames_.push_back({frames_.size(), color.stamp_ns, color.stamp_text, color.picture, color.stamp_ns, {}});
  for (const auto& [i, j] : pairs) {
    frames_[i].depth_stamp_ns = depth_.entries[j].stamp_ns;
    frames_[i].depth_path = depth_.entries[j].picture;
  }
  if (pairs.empty())
    return tl::unexpected(
        fmt::format("{}: no colour picture has a depth picture within {} ms (colour {} … {}, depth {} … {}), "
                    "expected rgb.txt and "
                    "depth.txt of one recording",
                    folder_.string(), options.pairing_tolerance_ns / 1'000'000,
                    color_.entries.front().stamp_text, color_.entries.back().stamp_text,
                    depth_.entries.front().stamp_text, depth_.entries.back().stamp_text));
  return {};
}

std::size_t TumDataset::without_depth() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(frames_, [](const FrameRef& frame) { return !frame.has_depth(); }));
}

std::string TumDataset::stamp_text(std::int64_t stamp_ns) const {
  const auto found = std::ranges::lower_bound(frames_, stamp_ns, {}, &FrameRef::stamp_ns);
  return found != frames_.end() && found->stamp_ns == stamp_ns ? found->stamp_text
                                                               : geometry::format_stamp(stamp_ns);
}

tl::expected<RgbdFrame, std::string> TumDataset::load(const FrameRef& frame) const {
  const cv::Size size(camera_.camera.width, camera_.camera.height);
  auto color = read_color_picture(frame.color_path, size);
  if (!color) return tl::unexpected(color.error());
  tl::expected<cv::Mat, std::string> depth = empty_depth(size).values;
  if (frame.has_depth()) depth = read_depth_picture(frame.depth_path, size);
  if (!depth) return tl::unexpected(depth.error());
  RgbdFrame result;
  result.stamp_ns = frame.stamp_ns;
  result.color.pixels = std::move(*color);
  result.depth.values = std::move(*depth);
  result.depth.metres_per_unit = static_cast<float>(1.0 / camera_.depth_scale);
  result.camera = camera_.camera;
  return result;
}

}  // namespace rds::image
