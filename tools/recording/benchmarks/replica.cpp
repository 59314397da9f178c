// SPDX-License-Identifier: Apache-2.0
#include <fstream>

#include <fmt/format.h>

#include "tools/recording/benchmarks/benchmarks.hpp"

namespace rds::recording {

std::optional<OpenedBenchmark> open_replica(const std::filesystem::path& folder) {
  std::error_code error;
  const auto pictures = folder / "results";
  const auto files = numbered_files(pictures, "frame", ".jpg");
  if (files.empty() || !std::filesystem::exists(folder / "traj.txt", error)) return std::nullopt;
  std::ifstream poses(folder / "traj.txt");
  std::vector<NumberedRecording::Entry> entries;
  NumberedRecording::Truth truth;
  for (const auto& [number, color] : files) {
    entries.push_back({number, color, pictures / fmt::format("depth{:06}.png", number)});
    if (const auto world_from_camera = read_matrix(poses)) truth.emplace_back(number, *world_from_camera);
  }
  const NumberedForm form{
      .camera = {.width = 1200, .height = 680, .fx = 600, .fy = 600, .cx = 599.5, .cy = 339.5},
      .depth_scale = 6553.5};
  return std::make_unique<NumberedRecording>(form, std::move(entries), truth);
}

}  // namespace rds::recording
