// SPDX-License-Identifier: Apache-2.0
#include <fstream>

#include <fmt/format.h>

#include "common/geometry/text_line.hpp"
#include "tools/recording/benchmarks/benchmarks.hpp"

namespace rds::recording {
namespace fs = std::filesystem;
namespace {

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;  // its poses' stamps are numbers of frames

std::optional<fs::path> truth_in(const fs::path& folder) {
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

tl::expected<std::vector<NumberedRecording::Entry>, std::string> listed_in(const fs::path& list) {
  std::ifstream in(list);
  std::vector<NumberedRecording::Entry> entries;
  std::string line;
  for (int row = 1; std::getline(in, line); ++row) {
    const auto words = geometry::split_words(line);
    if (words.empty() || line.starts_with('#')) continue;
    const auto number = number_in(words[0]);
    if (words.size() != 4 || !number)
      return tl::unexpected(fmt::format("{}:{}: expected `number depth number colour`, found {}",
                                        list.string(), row, geometry::shown(line)));
    entries.push_back(
        {*number, list.parent_path() / std::string(words[3]), list.parent_path() / std::string(words[1])});
  }
  if (entries.empty()) return tl::unexpected(fmt::format("{}: lists no pictures", list.string()));
  return entries;
}

tl::expected<NumberedRecording::Truth, std::string> poses_in(const fs::path& file) {
  const auto poses = geometry::read_trajectory(file);
  if (!poses) return tl::unexpected(poses.error());
  NumberedRecording::Truth truth;
  for (const auto& pose : *poses)
    truth.emplace_back(pose.stamp_ns / kNanosecondsPerSecond, mirrored_in_y(pose.map_from_camera));
  return truth;
}

}  // namespace

std::optional<OpenedBenchmark> open_icl_nuim(const fs::path& folder) {
  std::error_code error;
  const fs::path list = folder / "associations.txt";
  const auto truth_file = truth_in(folder);
  if (!truth_file || !fs::exists(list, error)) return std::nullopt;
  auto entries = listed_in(list);
  if (!entries) return tl::unexpected(entries.error());
  const auto truth = poses_in(*truth_file);
  if (!truth) return tl::unexpected(truth.error());
  const NumberedForm form{
      .camera = {.width = 640, .height = 480, .fx = 481.2, .fy = 480, .cx = 319.5, .cy = 239.5},
      .depth_scale = 5000};
  return std::make_unique<NumberedRecording>(form, std::move(*entries), *truth);
}

}  // namespace rds::recording
