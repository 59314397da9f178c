// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/box.hpp"
#include "tools/simulator/camera_path.hpp"
#include "tools/simulator/people/person.hpp"
#include "tools/simulator/people/walk.hpp"
#include "tools/simulator/rendering/renderer.hpp"
#include "tools/simulator/sensors/color_sensor.hpp"
#include "tools/simulator/sensors/depth_sensor.hpp"
#include "tools/simulator/world/scene.hpp"

namespace rds::simulator {

/// A camera without distortion with the same horizontal field of view at every size, 62.7°.
geometry::CameraModel camera_of_size(int width, int height);

enum class World : std::uint8_t { kRoom, kFloor };

struct SimulationOptions {
  World world = World::kRoom;
  PathKind path = PathKind::kXyz;  // of kRoom; on a floor the camera is a robot's
  int rooms = 12;                  // of kFloor
  int day = 0;                     // of kFloor, see make_floor()
  int people = 2;
  double seconds = 20;
  std::uint64_t seed = 1;
  double rate_hz = 30;
  geometry::CameraModel camera = camera_of_size(640, 480);
  double depth_units_per_metre = DepthSensor::kUnitsPerMetre;
  std::optional<double> odometry_scale;  // odometry.txt is written, of this scale (DeadReckoningErrors)
  bool imu = false;                      // imu.txt is written (InertialErrors)
};

/// Truth about one person in one picture; only people with visible pixels are listed.
struct PersonTruth {
  int id = 0;
  cv::Rect box;  // of the visible part [px]
  double visible_fraction =
      0;         // visible area / area of the whole silhouette were it unoccluded and the image unbounded
  int area = 0;  // visible [px]
  Eigen::Vector3d center_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_world = Eigen::Vector3d::Zero();
  double distance = 0;  // along the optical axis [m]
  std::string motion;   // walk, turn or stand
};

/// What a perfect detector would say about a labelled thing or person.
struct VisibleObject {
  std::string label;
  cv::Rect box;
  double depth_m = 0;  // median of its visible pixels
};

struct SimulatedFrame {
  cv::Mat color;  // CV_8UC3, BGR
  cv::Mat depth;  // CV_16UC1, SimulationOptions::depth_units_per_metre
  cv::Mat mask;   // CV_8UC1, 0 = background, k = pixel shows person k − 1
  std::vector<PersonTruth> people;
  std::vector<VisibleObject> visible;
};

/// A recording that exists as a function: any frame can be rendered at any time, from any thread.
///
/// World, camera path and sensor noise do not depend on the people, so `people = 0` gives the same recording
/// without them.
class Simulation {
 public:
  explicit Simulation(const SimulationOptions& options);

  [[nodiscard]] const SimulationOptions& options() const { return options_; }
  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] int frame_count() const;
  [[nodiscard]] double time_s(int frame) const { return frame / options_.rate_hz; }
  [[nodiscard]] geometry::Pose world_from_camera(double time_s) const { return camera_at_(time_s); }
  [[nodiscard]] const DepthSensor& depth_sensor() const { return depth_sensor_; }

  /// @param renderer  of the calling thread, made for options().camera.
  [[nodiscard]] SimulatedFrame frame(int index, Renderer& renderer) const;

 private:
  struct Actor {
    PersonLook look;
    Walk walk;
  };
  [[nodiscard]] bool may_be_seen(const Motion& motion, const std::vector<std::size_t>& visible) const;
  [[nodiscard]] PersonTruth truth_of(int id, double time_s, const Mesh& mesh, const cv::Mat& mask,
                                     const geometry::Pose& pose) const;
  void observe_objects(const Rendering& rendering, const geometry::Pose& pose, SimulatedFrame& out) const;

  SimulationOptions options_;
  Scene scene_;
  WalkPlanner::CameraAt camera_at_;
  ColorSensor color_sensor_;
  DepthSensor depth_sensor_;
  std::vector<Actor> actors_;
};

}  // namespace rds::simulator
