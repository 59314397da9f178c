// SPDX-License-Identifier: Apache-2.0
#include "common/image/tum_dataset.hpp"

#include <fmt/format.h>

#include "common/image/picture_file.hpp"
#include "common/image/sensors/imu_file.hpp"
#include "common/image/sensors/odometry_file.hpp"

namespace rds::image {

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
  if (auto paired = dataset.pair_lists(options); !paired) return tl::unexpected(paired.error());
  if (std::filesystem::exists(folder / "groundtruth.txt")) {
    auto truth = geometry::read_trajectory(folder / "groundtruth.txt");
    if (!truth) return tl::unexpected(truth.error());
    dataset.ground_truth_ = std::move(*truth);
  }
  if (auto sensors = dataset.read_sensors(); !sensors) return tl::unexpected(sensors.error());
  return dataset;
}

tl::expected<void, std::string> TumDataset::read_sensors() {
  if (const auto file = folder_ / "odometry.txt"; std::filesystem::exists(file)) {
    auto odometry = read_odometry(file);
    if (!odometry) return tl::unexpected(odometry.error());
    sensors_.odometry = std::move(*odometry);
  }
  if (const auto file = folder_ / "imu.txt"; std::filesystem::exists(file)) {
    auto imu = read_imu(file);
    if (!imu) return tl::unexpected(imu.error());
    sensors_.imu = std::move(*imu);
  }
  return {};
}

tl::expected<void, std::string> TumDataset::read_camera() {
  const auto file = folder_ / "camera.yaml";
  tl::expected<CameraDescription, std::string> description;
  if (std::filesystem::exists(file)) {
    description = read_camera_yaml(file);
    if (!description) return tl::unexpected(description.error());
  } else {
    const auto known = known_camera_of_folder(std::filesystem::weakly_canonical(folder_).filename().string());
    if (!known)
      return tl::unexpected(fmt::format(
          "{}: no such file, expected the camera's description (or a folder named after freiburg1, "
          "freiburg2, freiburg3 or rgbd_bonn)",
          file.string()));
    description = *known;
  }
  camera_ = description->camera;
  fps_ = description->fps;
  depth_scale_ = description->depth_scale;
  return {};
}

tl::expected<void, std::string> TumDataset::pair_lists(const TumDatasetOptions& options) {
  repeated_ = color_.repeated + depth_.repeated;
  std::vector<FrameRef> frames;
  for (const auto& color : color_.entries)
    frames.push_back({frames.size(), color.stamp_ns, color.stamp_text});
  std::vector<std::int64_t> depth_stamps;
  for (const auto& depth : depth_.entries) depth_stamps.push_back(depth.stamp_ns);
  if (pair_frames(std::move(frames), std::move(depth_stamps), options.pairing_tolerance_ns) > 0) return {};
  return tl::unexpected(fmt::format(
      "{}: no colour picture has a depth picture within {} ms (colour {} … {}, depth {} … {}), "
      "expected rgb.txt and depth.txt of one recording",
      folder_.string(), options.pairing_tolerance_ns / 1'000'000, color_.entries.front().stamp_text,
      color_.entries.back().stamp_text, depth_.entries.front().stamp_text, depth_.entries.back().stamp_text));
}

std::vector<std::filesystem::path> TumDataset::missing() const {
  std::vector<std::filesystem::path> missing;
  std::error_code error;
  for (const TumList* list : {&color_, &depth_})
    for (const auto& entry : list->entries)
      if (!std::filesystem::is_regular_file(entry.picture, error)) missing.push_back(entry.picture);
  return missing;
}

tl::expected<ColorImage, std::string> TumDataset::load_color(std::size_t index) const {
  auto pixels = read_color_picture(color_.entries[index].picture, {camera_.width, camera_.height});
  if (!pixels) return tl::unexpected(pixels.error());
  return ColorImage{std::move(*pixels), ChannelOrder::kBgr, nullptr};
}

tl::expected<DepthImage, std::string> TumDataset::load_depth(std::size_t index) const {
  auto values = read_depth_picture(depth_.entries[index].picture, {camera_.width, camera_.height});
  if (!values) return tl::unexpected(values.error());
  return DepthImage{std::move(*values), static_cast<float>(1.0 / depth_scale_), nullptr};
}

}  // namespace rds::image
