// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/recording.hpp"

#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include <opencv2/imgcodecs.hpp>
#include <yaml-cpp/yaml.h>

namespace rds::bench {
namespace fs = std::filesystem;
namespace {

constexpr double kPairingToleranceS = 0.02;

struct ListedFile {
  std::string stamp;
  fs::path path;
};

std::vector<ListedFile> read_list(const fs::path& list) {
  std::ifstream file(list);
  std::vector<ListedFile> files;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    ListedFile listed;
    std::string path;
    if (line.starts_with('#') || !(words >> listed.stamp >> path)) continue;
    listed.path = list.parent_path() / path;
    files.push_back(listed);
  }
  return files;
}

}  // namespace

std::vector<RecordedFrame> list_frames(const fs::path& dataset) {
  const auto colors = read_list(dataset / "rgb.txt");
  const auto depths = read_list(dataset / "depth.txt");
  if (colors.empty())
    throw std::runtime_error((dataset / "rgb.txt").string() + ": expected a list of pictures");
  std::vector<RecordedFrame> frames;
  for (const ListedFile& color : colors) {
    RecordedFrame frame{color.stamp, color.path, {}};
    double nearest = kPairingToleranceS;
    for (const ListedFile& depth : depths) {
      const double gap = std::abs(std::stod(depth.stamp) - std::stod(color.stamp));
      if (gap > nearest) continue;
      nearest = gap;
      frame.depth = depth.path;
    }
    frames.push_back(frame);
  }
  return frames;
}

float metres_per_unit(const fs::path& dataset) {
  constexpr float kTumUnitsPerMetre = 5000;
  if (!fs::exists(dataset / "camera.yaml")) return 1 / kTumUnitsPerMetre;
  return 1 / YAML::LoadFile((dataset / "camera.yaml").string())["depth_scale"].as<float>();
}

image::DepthImage load_depth(const RecordedFrame& frame, float metres_per_unit) {
  image::DepthImage depth;
  depth.metres_per_unit = metres_per_unit;
  if (!frame.depth.empty()) depth.values = cv::imread(frame.depth.string(), cv::IMREAD_UNCHANGED);
  return depth;
}

}  // namespace rds::bench
