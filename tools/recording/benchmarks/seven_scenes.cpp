// SPDX-License-Identifier: Apache-2.0
#include <fstream>

#include "tools/recording/benchmarks/benchmarks.hpp"

namespace rds::recording {

std::optional<OpenedBenchmark> open_seven_scenes(const std::filesystem::path& folder) {
  constexpr std::string_view kColor = ".color.png";
  const auto files = numbered_files(folder, "frame-", kColor);
  if (files.empty()) return std::nullopt;
  std::vector<NumberedRecording::Entry> entries;
  NumberedRecording::Truth truth;
  for (const auto& [number, color] : files) {
    const std::string name = color.filename().string();
    const std::string stem = name.substr(0, name.size() - kColor.size());
    entries.push_back({number, color, folder / (stem + ".depth.png")});
    std::ifstream pose(folder / (stem + ".pose.txt"));
    if (const auto world_from_camera = read_matrix(pose)) truth.emplace_back(number, *world_from_camera);
  }
  const NumberedForm form{.camera = {.width = 640, .height = 480, .fx = 585, .fy = 585, .cx = 320, .cy = 240},
                          .no_depth = 65535};
  return std::make_unique<NumberedRecording>(form, std::move(entries), truth);
}

}  // namespace rds::recording
