// SPDX-License-Identifier: Apache-2.0
#include "tools/recording/numbered_recording.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <optional>

#include <fmt/format.h>

#include "common/geometry/stamp.hpp"
#include "common/geometry/text_line.hpp"
#include "common/image/picture_file.hpp"

namespace rds::recording {
namespace fs = std::filesystem;
namespace {

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
constexpr std::int64_t kFramesPerSecond = 30;
constexpr std::int64_t kStartS = 1;  // stamp of frame 0; a stamp of 0 is nobody's
constexpr std::uint64_t kMostNumber = 1'000'000'000;

constexpr const char* kSevenScenesStart = "frame-";
constexpr const char* kSevenScenesColor = ".color.png";
constexpr const char* kAssociations = "associations.txt";

std::int64_t stamp_of(std::uint64_t number) {
  return kStartS * kNanosecondsPerSecond +
         static_cast<std::int64_t>(number) * kNanosecondsPerSecond / kFramesPerSecond;
}

geometry::CameraModel vga_camera(double fx, double fy, double cx, double cy) {
  return {.width = 640, .height = 480, .fx = fx, .fy = fy, .cx = cx, .cy = cy};
}

std::optional<std::uint64_t> number_in(std::string_view text) {
  const auto number = geometry::parse_number(text);
  if (!number || *number < 0 || *number > static_cast<double>(kMostNumber)) return std::nullopt;
  return static_cast<std::uint64_t>(*number);
}

/// 000012 of frame-000012.color.png; nullopt for another name.
std::optional<std::uint64_t> seven_scenes_number(const std::string& name) {
  if (!name.starts_with(kSevenScenesStart) || !name.ends_with(kSevenScenesColor)) return std::nullopt;
  const std::size_t start = std::string_view(kSevenScenesStart).size();
  return number_in(std::string_view(name).substr(start, name.find('.') - start));
}

/// A 4×4 matrix, world from camera, row by row.
std::optional<geometry::Pose> read_matrix(const fs::path& file) {
  std::ifstream in(file);
  Eigen::Matrix4d matrix;
  for (int i = 0; i < 16; ++i)
    if (!(in >> matrix(i / 4, i % 4))) return std::nullopt;
  const Eigen::Quaterniond rotation(Eigen::Matrix3d(matrix.topLeftCorner<3, 3>()));
  if (!matrix.allFinite() || rotation.norm() < 0.5) return std::nullopt;
  return geometry::make_pose(matrix.topRightCorner<3, 1>(), rotation);
}

std::optional<fs::path> truth_of_icl_nuim(const fs::path& folder) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (entry.path().filename().string().ends_with(".gt.freiburg")) return entry.path();
  return std::nullopt;
}

/// The pose in a world that is mirrored in y, as its camera is.
geometry::Pose mirrored_in_y(const geometry::Pose& pose) {
  const Eigen::Vector3d t = pose.translation();
  const Eigen::Quaterniond q(pose.linear());
  return geometry::make_pose({t.x(), -t.y(), t.z()}, {q.w(), -q.x(), q.y(), -q.z()});
}

}  // namespace

NumberedRecording::NumberedRecording(const geometry::CameraModel& camera, double depth_scale,
                                     std::uint16_t no_depth)
    : no_depth_(no_depth) {
  camera_ = camera;
  depth_scale_ = depth_scale;
  fps_ = static_cast<double>(kFramesPerSecond);
}

void NumberedRecording::set_entries(std::vector<Entry> entries) {
  std::ranges::sort(entries, {}, &Entry::number);
  const auto repeated = std::ranges::unique(entries, {}, &Entry::number);
  entries.erase(repeated.begin(), repeated.end());
  entries_ = std::move(entries);
  std::vector<image::FrameRef> frames;
  std::vector<std::int64_t> stamps;
  for (const Entry& entry : entries_) {
    const std::int64_t stamp_ns = stamp_of(entry.number);
    frames.push_back({frames.size(), stamp_ns, geometry::format_stamp(stamp_ns)});
    stamps.push_back(stamp_ns);
  }
  pair_frames(std::move(frames), std::move(stamps), 0);
}

bool NumberedRecording::is_seven_scenes(const fs::path& folder) {
  std::error_code error;
  return std::ranges::any_of(fs::directory_iterator(folder, error), [](const fs::directory_entry& entry) {
    return seven_scenes_number(entry.path().filename().string()).has_value();
  });
}

NumberedRecording::Opened NumberedRecording::open_seven_scenes(const fs::path& folder) {
  constexpr std::uint16_t kNoDepth = 65535;
  std::unique_ptr<NumberedRecording> recording(
      new NumberedRecording(vga_camera(585, 585, 320, 240), 1000, kNoDepth));
  std::vector<Entry> entries;
  std::error_code error;
  for (const auto& file : fs::directory_iterator(folder, error)) {
    const std::string name = file.path().filename().string();
    const auto number = seven_scenes_number(name);
    if (!number) continue;
    const std::string stem = name.substr(0, name.find('.'));
    entries.push_back({*number, file.path(), folder / (stem + ".depth.png")});
  }
  recording->set_entries(std::move(entries));
  std::vector<geometry::StampedPose> truth;
  for (const Entry& entry : recording->entries_) {
    const std::string name = entry.color.filename().string();
    const auto pose = read_matrix(folder / (name.substr(0, name.find('.')) + ".pose.txt"));
    if (pose) truth.push_back({stamp_of(entry.number), *pose, ""});
  }
  if (!truth.empty()) recording->ground_truth_ = std::move(truth);
  return recording;
}

bool NumberedRecording::is_icl_nuim(const fs::path& folder) {
  std::error_code error;
  return fs::exists(folder / kAssociations, error) && !fs::exists(folder / "rgb.txt", error) &&
         truth_of_icl_nuim(folder).has_value();
}

NumberedRecording::Opened NumberedRecording::open_icl_nuim(const fs::path& folder) {
  std::unique_ptr<NumberedRecording> recording(
      new NumberedRecording(vga_camera(481.2, 480, 319.5, 239.5), 5000, 0));
  std::ifstream in(folder / kAssociations);
  std::vector<Entry> entries;
  std::string line;
  for (int row = 1; std::getline(in, line); ++row) {
    const auto words = geometry::split_words(line);
    if (words.empty() || line.starts_with('#')) continue;
    const auto number = number_in(words[0]);
    if (words.size() != 4 || !number)
      return tl::unexpected(fmt::format("{}:{}: expected `number depth number colour`, found {}",
                                        (folder / kAssociations).string(), row, geometry::shown(line)));
    entries.push_back({*number, folder / std::string(words[3]), folder / std::string(words[1])});
  }
  if (entries.empty())
    return tl::unexpected(fmt::format("{}: lists no pictures", (folder / kAssociations).string()));
  recording->set_entries(std::move(entries));
  auto truth = geometry::read_trajectory(*truth_of_icl_nuim(folder));
  if (!truth) return tl::unexpected(truth.error());
  for (auto& pose : *truth) {
    pose.stamp_ns = stamp_of(static_cast<std::uint64_t>(pose.stamp_ns / kNanosecondsPerSecond));
    pose.stamp_text.clear();
    pose.map_from_camera = mirrored_in_y(pose.map_from_camera);
  }
  recording->ground_truth_ = std::move(*truth);
  return recording;
}

tl::expected<image::ColorImage, std::string> NumberedRecording::load_color(std::size_t index) const {
  auto pixels = image::read_color_picture(entries_[index].color, {camera_.width, camera_.height});
  if (!pixels) return tl::unexpected(pixels.error());
  return image::ColorImage{std::move(*pixels), image::ChannelOrder::kBgr, nullptr};
}

tl::expected<image::DepthImage, std::string> NumberedRecording::load_depth(std::size_t index) const {
  auto values = image::read_depth_picture(entries_[index].depth, {camera_.width, camera_.height});
  if (!values) return tl::unexpected(values.error());
  if (no_depth_ != 0) values->setTo(0, *values == no_depth_);
  return image::DepthImage{std::move(*values), static_cast<float>(1 / depth_scale_), nullptr};
}

}  // namespace rds::recording
