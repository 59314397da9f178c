// SPDX-License-Identifier: Apache-2.0
#include "tests/support/grid/grid_walls.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include <opencv2/imgcodecs.hpp>
#include <yaml-cpp/yaml.h>

#include "common/geometry/trajectory.hpp"
#include "common/image/tum_dataset.hpp"

namespace rds::test {
namespace {

constexpr std::size_t kFrames = 5;               // from one picture that is looked at to the next
constexpr std::int64_t kMaxGapNs = 100'000'000;  // between two poses that a picture's is interpolated of
constexpr int kStep = 6;                         // px between neighbours that a normal is made of
constexpr double kMaxDepthM = 3.5;
constexpr double kMaxEdgeM = 0.1;    // between such neighbours
constexpr double kMaxUp = 0.17;      // of a wall's normal: 10 degrees
constexpr double kMaxHeightM = 0.4;  // above and below the first camera: within the grid's band of heights

/// As map_server reads it.
class Grid {
 public:
  explicit Grid(const std::filesystem::path& folder) {
    const YAML::Node about = YAML::LoadFile(folder / "grid.yaml");
    resolution_m_ = about["resolution"].as<double>();
    origin_ = {about["origin"][0].as<double>(), about["origin"][1].as<double>()};
    cells_ = cv::imread((folder / "grid.pgm").string(), cv::IMREAD_GRAYSCALE);
    if (cells_.empty()) throw std::runtime_error("grid.pgm is no picture");
  }
  [[nodiscard]] bool is_occupied(const Eigen::Vector3d& point) const {
    const int x = static_cast<int>(std::floor((point.x() - origin_.x()) / resolution_m_));
    const int y = cells_.rows - 1 - static_cast<int>(std::floor((point.y() - origin_.y()) / resolution_m_));
    return x >= 0 && y >= 0 && x < cells_.cols && y < cells_.rows && cells_(y, x) == 0;
  }

 private:
  double resolution_m_ = 0;
  Eigen::Vector2d origin_;
  cv::Mat1b cells_;  // 0: occupied
};

/// Point and normal at a pixel, in the camera's frame; nullopt at edges and where nothing is measured.
std::optional<std::pair<Eigen::Vector3d, Eigen::Vector3d>> surface_at(const image::DepthImage& depth,
                                                                      const geometry::CameraModel& camera,
                                                                      int x, int y) {
  const double here_m = depth.at(x, y);
  const auto point = [&](int column, int row) {
    const double z = depth.at(column, row);
    const bool is_near = z > 0 && std::abs(z - here_m) < kMaxEdgeM;
    return Eigen::Vector3d((is_near ? z : std::nan("")) * camera.ray({column, row}));
  };
  if (here_m <= 0 || here_m > kMaxDepthM) return std::nullopt;
  const Eigen::Vector3d normal = (point(x + kStep, y) - point(x - kStep, y))
                                     .cross(point(x, y + kStep) - point(x, y - kStep))
                                     .normalized();
  if (!normal.allFinite()) return std::nullopt;
  return std::pair{point(x, y), normal};
}

/// Trajectories are in the frame of the first picture, keyframes and grid in the map's, which is level.
geometry::Pose map_from_trajectory_of(const std::filesystem::path& out,
                                      const std::vector<geometry::StampedPose>& trajectory) {
  const auto keyframes = geometry::read_trajectory(out / "keyframes.txt").value();
  const auto& last = keyframes.at(keyframes.size() - 1);
  return last.map_from_camera * geometry::pose_at(trajectory, last.stamp_ns, 0).value().inverse();
}

}  // namespace

double walls_over_occupied(const std::filesystem::path& dataset, const std::filesystem::path& out) {
  const auto recording = image::TumDataset::open(dataset).value();
  const Grid grid(out);
  int all = 0, over = 0;
  const auto trajectory = geometry::read_trajectory(out / "trajectory_optimized.txt").value();
  const geometry::Pose map_from_trajectory = map_from_trajectory_of(out, trajectory);
  for (std::size_t i = 0; i < recording.frames().size(); i += kFrames) {
    const image::FrameRef& frame = recording.frames()[i];
    const auto pose = geometry::pose_at(trajectory, frame.stamp_ns, kMaxGapNs);
    if (!pose || !frame.depth) continue;
    const geometry::Pose map_from_camera = map_from_trajectory * *pose;
    const auto depth = recording.load_depth(*frame.depth).value();
    for (int y = kStep; y < depth.values.rows - kStep; y += kStep)
      for (int x = kStep; x < depth.values.cols - kStep; x += kStep) {
        const auto surface = surface_at(depth, recording.camera(), x, y);
        if (!surface || std::abs((map_from_camera.linear() * surface->second).z()) > kMaxUp) continue;
        const Eigen::Vector3d point = map_from_camera * surface->first;
        if (std::abs(point.z()) > kMaxHeightM) continue;
        ++all;
        over += grid.is_occupied(point) ? 1 : 0;
      }
  }
  return static_cast<double>(over) / all;
}

}  // namespace rds::test
