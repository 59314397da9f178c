// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/robot_path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/simulator/camera_path.hpp"
#include "tools/simulator/rendering/random.hpp"
#include "tools/simulator/tour.hpp"

namespace rds::simulator {
namespace {

constexpr std::uint64_t kDriveStream = 21;
constexpr double kPi = std::numbers::pi;
constexpr double kAcceleration = 0.6;      // [m/s²]
constexpr double kTurnAcceleration = 2.4;  // [rad/s²]
constexpr double kDrivingTurnRate = 0.95;  // [rad/s]
constexpr double kLookingTurnRate = 0.65;  // [rad/s]
constexpr double kLookAhead = 0.45;        // on the way [m]
constexpr double kSpacing = 0.05;          // of the points of a line [m]
constexpr double kArrived = 0.02;          // [m]
constexpr double kPitch = 0.1;             // downwards [rad]
constexpr double kFastestCruise = 0.75;    // leaves room for the line's corners [m/s]

double wrapped(double angle) {
  return std::remainder(angle, 2 * kPi);
}

double approached(double value, double wanted, double step) {
  return value + std::clamp(wanted - value, -step, step);
}

Eigen::Vector2d point_on(const std::vector<Eigen::Vector2d>& line, double along_m) {
  const double index = std::clamp(along_m / kSpacing, 0.0, static_cast<double>(line.size() - 1));
  const auto i = std::min(static_cast<std::size_t>(index), line.size() - 2);
  return line[i] + (index - static_cast<double>(i)) * (line[i + 1] - line[i]);
}

/// The same line with a point every kSpacing.
std::vector<Eigen::Vector2d> resampled(const std::vector<Eigen::Vector2d>& line) {
  std::vector<Eigen::Vector2d> out;
  double next = 0;  // where the next point is, from the present corner on
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Eigen::Vector2d edge = line[i] - line[i - 1];
    const double length = edge.norm();
    for (; next < length; next += kSpacing) out.emplace_back(line[i - 1] + edge * (next / length));
    next -= length;
  }
  return out;
}

}  // namespace

/// Drives along lines, turns and waits, and writes down where the robot is after each step.
class RobotDrive {
 public:
  explicit RobotDrive(const Eigen::Vector2d& start) : state_{start, 0} { samples_.push_back(state_); }

  [[nodiscard]] double seconds() const { return static_cast<double>(samples_.size()) * RobotPath::kStepS; }
  [[nodiscard]] const Eigen::Vector2d& position() const { return state_.position; }
  [[nodiscard]] double heading() const { return state_.heading_rad; }

  /// Along a line; slower where it bends, at rest at its end.
  void follow(const std::vector<Eigen::Vector2d>& way, double cruise) {
    const auto line = resampled(way);
    if (line.size() < 2) return;
    const double length = static_cast<double>(line.size() - 1) * kSpacing;
    double along = 0;
    double speed = 0;
    while (length - along > kArrived) {
      const Eigen::Vector2d ahead = point_on(line, along + kLookAhead) - state_.position;
      const double error = wrapped(std::atan2(ahead.y(), ahead.x()) - state_.heading_rad);
      const double facing = std::clamp((std::cos(error) - 0.6) / 0.35, 0.0, 1.0);
      const double braking = std::sqrt(2 * kAcceleration * (length - along));
      speed = approached(speed, std::min(cruise * facing, braking), 2 * kAcceleration * RobotPath::kStepS);
      along += speed * RobotPath::kStepS;
      state_.position = point_on(line, along);
      turn(error, kDrivingTurnRate);
    }
  }

  void turn_to(double heading_rad) {
    for (double error = 1; std::abs(error) > 0.02 || std::abs(rate_) > 0.05;) {
      error = heading_rad - state_.heading_rad;
      turn(error, kLookingTurnRate);
    }
  }

  void wait(double seconds) {
    for (double t = 0; t < seconds; t += RobotPath::kStepS) turn(0, kLookingTurnRate);
  }

  std::vector<RobotPath::State> take() && { return std::move(samples_); }

 private:
  /// One step of turning towards what is `error` to the left.
  void turn(double error, double fastest) {
    const double wanted = std::clamp(2.5 * error, -fastest, fastest);
    rate_ = approached(rate_, wanted, kTurnAcceleration * RobotPath::kStepS);
    state_.heading_rad += rate_ * RobotPath::kStepS;
    samples_.push_back(state_);
  }

  RobotPath::State state_;
  double rate_ = 0;  // of turning [rad/s]
  std::vector<RobotPath::State> samples_;
};

RobotPath::RobotPath(const Scene& scene, double seconds, std::uint64_t seed) {
  Random random(seed, kDriveStream);
  FloorMap floor(scene, kClearanceM);
  const Eigen::Vector2d start = floor.nearest_free(scene.rooms.front().box.center().head<2>());
  floor.keep_connected_to(start);
  Tour tour(scene, floor, seed);
  RobotDrive drive(start);
  while (drive.seconds() < seconds + kStepS) {
    const Eigen::Vector2d goal = tour.next(drive.position());
    drive.follow(floor.path(drive.position(), goal), random.uniform(kSlowestM_s, kFastestCruise));
    const double side = random.sign();
    drive.turn_to(drive.heading() + side * random.uniform(0.8, 2.8));
    if (random.chance(0.4)) drive.wait(random.uniform(0.5, 2.0));
  }
  samples_ = std::move(drive).take();
}

geometry::Pose RobotPath::world_from_camera(double time_s) const {
  const double index = std::clamp(time_s / kStepS, 0.0, static_cast<double>(samples_.size() - 1));
  const auto i = std::min(static_cast<std::size_t>(index), samples_.size() - 2);
  const double f = index - static_cast<double>(i);
  const State& a = samples_[i];
  const State& b = samples_[i + 1];
  const Eigen::Vector2d position = a.position + f * (b.position - a.position);
  const double heading = a.heading_rad + f * (b.heading_rad - a.heading_rad);
  const Eigen::Vector3d eye(position.x(), position.y(), kCameraHeightM);
  return look_at(eye, eye + Eigen::Vector3d(std::cos(heading), std::sin(heading), -std::tan(kPitch)));
}

}  // namespace rds::simulator
