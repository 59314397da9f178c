// SPDX-License-Identifier: Apache-2.0
#include "common/image/camera_yaml.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "common/config/config_reader.hpp"

namespace rds::image {
namespace {
constexpr double kHighestFocalLengthPx = 1e5;
constexpr int kLargestSidePx = 16384;
constexpr std::size_t kDistortionTerms = 5;

template <class T>
void required(config::ConfigReader& reader, const std::string& key, T& target, T lowest, T highest,
              const std::string& unit) {
  reader.value(key, target, lowest, highest, unit);
  if (!reader.has(key))
    reader.violation(key, "missing", fmt::format("expected {} … {} {}", lowest, highest, unit));
}

void read_distortion(config::ConfigReader& reader, std::array<double, kDistortionTerms>& target) {
  std::vector<double> terms;
  reader.value("distortion", terms);
  if (terms.size() == kDistortionTerms &&
      std::ranges::all_of(terms, [](double k) { return std::isfinite(k); }))
    std::ranges::copy(terms, target.begin());
  else
    reader.violation("distortion", fmt::format("{} terms", terms.size()), "expected [k1, k2, p1, p2, k3]");
}

CameraDescription vga_camera(double fx, double fy, double cx, double cy, std::array<double, 5> distortion) {
  return {{.width = 640, .height = 480, .fx = fx, .fy = fy, .cx = cx, .cy = cy, .distortion = distortion},
          5000,
          30};
}

}  // namespace

tl::expected<CameraDescription, std::string> read_camera_yaml(const std::filesystem::path& file) {
  try {
    auto reader = config::ConfigReader::from_file(file.string());
    CameraDescription result;
    auto& camera = result.camera;
    required(reader, "width", camera.width, 16, kLargestSidePx, "px");
    required(reader, "height", camera.height, 16, kLargestSidePx, "px");
    required(reader, "fx", camera.fx, 1.0, kHighestFocalLengthPx, "px");
    required(reader, "fy", camera.fy, 1.0, kHighestFocalLengthPx, "px");
    required(reader, "cx", camera.cx, 0.0, static_cast<double>(kLargestSidePx), "px");
    required(reader, "cy", camera.cy, 0.0, static_cast<double>(kLargestSidePx), "px");
    required(reader, "depth_scale", result.depth_scale, 1.0, 1e6, "units per metre");
    reader.value("fps", result.fps, 0.1, 1000.0, "1/s");
    read_distortion(reader, camera.distortion);
    reader.finish();
    return result;
  } catch (const config::ConfigError& e) {
    return tl::unexpected<std::string>(e.what());
  } catch (const YAML::Exception& e) {
    return tl::unexpected(fmt::format("{}: {}", file.string(), e.what()));
  }
}

std::optional<CameraDescription> known_camera_of_folder(const std::string& folder_name) {
  if (folder_name.find("freiburg1") != std::string::npos)
    return vga_camera(517.3, 516.5, 318.6, 255.3, {0.2624, -0.9531, -0.0054, 0.0026, 1.1633});
  if (folder_name.find("freiburg2") != std::string::npos)
    return vga_camera(520.9, 521.0, 325.1, 249.7, {0.2312, -0.7849, -0.0033, -0.0001, 0.9172});
  if (folder_name.find("freiburg3") != std::string::npos) return vga_camera(535.4, 539.2, 320.1, 247.6, {});
  if (folder_name.find("rgbd_bonn") != std::string::npos)
    return vga_camera(542.822841, 542.576870, 315.593520, 237.756098,
                      {0.039903, -0.099343, -0.000730, -0.000144, 0});
  return std::nullopt;
}

}  // namespace rds::image
