// SPDX-License-Identifier: Apache-2.0
#include "tools/evaluation/objects/shown_things.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace rds::evaluation {
namespace {

using geometry::Box2;
using nlohmann::json;

constexpr std::size_t kEvery = 8;  // frames, as many as come to a keyframe
constexpr int kMinViews = 5;       // of those
constexpr double kMaxDepthM = 4;   // as far as the mapper inserts points
constexpr double kMinIou = 0.5;
constexpr double kNearestM = 0.2;

DetectedFrame frame_from(const json& line) {
  DetectedFrame frame{std::llround(line.at("stamp").get<double>() * 1e9), {}};
  for (const json& detection : line.at("detections")) {
    const auto b = detection.at("box").get<std::array<double, 4>>();
    frame.boxes.push_back({detection.at("label").get<std::string>(),
                           {b[0], b[1], b[2], b[3]},
                           detection.value("depth_m", 0.0)});
  }
  return frame;
}

/// Around the corners of a box, also outside the picture; without area if a part is not before the camera.
Box2 whole_box(const geometry::OrientedBox& box, const geometry::Pose& camera_from_world,
               const geometry::CameraModel& camera) {
  Box2 whole{1e9, 1e9, -1e9, -1e9};
  for (const Eigen::Vector3d& corner : box.corners()) {
    const Eigen::Vector3d p = camera_from_world * corner;
    if (p.z() < kNearestM) return {};
    const Eigen::Vector2d px = camera.project_undistorted(p);
    whole = {std::min(whole.x0, px.x()), std::min(whole.y0, px.y()), std::max(whole.x1, px.x()),
             std::max(whole.y1, px.y())};
  }
  return whole;
}

}  // namespace

tl::expected<std::vector<DetectedFrame>, std::string> read_detected_frames(
    const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<DetectedFrame> frames;
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (line.empty()) continue;
    try {
      frames.push_back(frame_from(json::parse(line)));
    } catch (const json::exception&) {
      return tl::unexpected(fmt::format(
          R"({}:{}: expected {{"stamp": s, "detections": [{{"label": "chair", "box": [4 numbers]}}]}})",
          file.string(), number));
    }
  }
  return frames;
}

std::vector<bool> which_showed(std::span<const LabelledThing> things, std::span<const DetectedFrame> frames,
                               std::span<const geometry::StampedPose> world_from_camera,
                               const geometry::CameraModel& camera) {
  std::vector<int> views(things.size(), 0);
  for (std::size_t n = 0; n < frames.size(); n += kEvery) {
    const geometry::Pose camera_from_world =
        geometry::interpolate(world_from_camera, frames[n].stamp_ns).inverse();
    for (std::size_t i = 0; i < things.size(); ++i) {
      const Box2 whole = whole_box(things[i].box, camera_from_world, camera);
      views[i] += std::ranges::any_of(frames[n].boxes, [&](const ImageBox& seen) {
        return seen.label == things[i].label && seen.depth_m < kMaxDepthM && iou(seen.box, whole) >= kMinIou;
      });
    }
  }
  std::vector<bool> showed;
  for (const int count : views) showed.push_back(count >= kMinViews);
  return showed;
}

}  // namespace rds::evaluation
