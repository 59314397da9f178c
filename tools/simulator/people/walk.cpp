// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/people/walk.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rds::simulator {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kAcceleration = 1.1;  // [m/s²]
constexpr double kTurnRate = 2.6;      // [rad/s]
constexpr double kCameraRoom = 0.95;   // people keep this far from the camera [m]
constexpr double kPersonRoom = 0.6;    // and from each other
constexpr double kWantedCover = 0.15;  // share of the picture
constexpr double kPlanningStepS = 0.2;
constexpr int kWays = 10;                   // that are compared before each leg
constexpr int kWaysOnFloor = 4;             // a way through a building takes long to find
constexpr double kWhim = 0.25;              // added to a score: the best way is not always taken
constexpr double kWhimOnFloor = 0.9;        // people have other things to do than to be seen
constexpr double kInViewProbability = 0.4;  // of a goal, where people walk from room to room
constexpr int kRoomsAround = 5;
constexpr double kThinWall = 0.03;  // [m]

double wrapped(double angle) {
  return std::remainder(angle, 2 * kPi);
}

double turned_towards(double heading, double wanted, double step) {
  return heading + std::clamp(wrapped(wanted - heading), -step, step);
}

}  // namespace

void Walk::append(const Walk& other) {
  samples_.insert(samples_.end(), other.samples_.begin(), other.samples_.end());
}

Motion Walk::at(double time_s) const {
  const double index = std::clamp(time_s / kStepS, 0.0, static_cast<double>(samples_.size() - 1));
  const auto i = std::min(static_cast<std::size_t>(index), samples_.size() - 1);
  const Motion& a = samples_[i];
  const Motion& b = samples_[std::min(i + 1, samples_.size() - 1)];
  const double f = index - static_cast<double>(i);
  Motion m = a;
  m.position = a.position + f * (b.position - a.position);
  m.heading_rad = a.heading_rad + f * wrapped(b.heading_rad - a.heading_rad);
  m.speed = a.speed + f * (b.speed - a.speed);
  m.phase_rad = a.phase_rad + f * (b.phase_rad - a.phase_rad);
  m.gesture_weight = a.gesture_weight + f * (b.gesture_weight - a.gesture_weight);
  m.time_s = time_s;
  return m;
}

Eigen::Vector2d Walk::velocity(double time_s) const {
  constexpr double kHalf = 0.02;
  return (at(time_s + kHalf).position - at(time_s - kHalf).position) / (2 * kHalf);
}

WalkPlanner::WalkPlanner(const FloorMap& floor, const geometry::CameraModel& camera,
                         CameraAt world_from_camera, double seconds)
    : floor_(floor), camera_(camera), world_from_camera_(std::move(world_from_camera)), seconds_(seconds) {}

Walk WalkPlanner::leg(const Motion& start, const Eigen::Vector2d& goal, double speed, double pause_s,
                      Random& random) const {
  Walk walk;
  Motion m = start;
  const auto line = floor_.path(start.position, goal);
  const auto advance = [&](double wanted_heading, double wanted_speed) {
    m.heading_rad = turned_towards(m.heading_rad, wanted_heading, kTurnRate * Walk::kStepS);
    m.speed +=
        std::clamp(wanted_speed - m.speed, -2 * kAcceleration * Walk::kStepS, kAcceleration * Walk::kStepS);
    // Turning on the spot takes small steps.
    const double stepping =
        std::max(m.speed, 0.25 * std::min(1.0, std::abs(wrapped(wanted_heading - m.heading_rad))));
    m.phase_rad += 2 * kPi * stepping / stride_length(stepping, 1.75F) * Walk::kStepS;
    m.time_s += Walk::kStepS;
  };
  double along = 0;  // in points of the line
  const double spacing = 0.05;
  for (int guard = 0; guard < 3000 && along + 1.5 < static_cast<double>(line.size()); ++guard) {
    const auto i = static_cast<std::size_t>(along);
    const auto ahead = std::min(i + 6, line.size() - 1);
    const Eigen::Vector2d direction = line[ahead] - line[i];
    const double wanted = std::atan2(direction.y(), direction.x());
    const double left = (static_cast<double>(line.size()) - 1 - along) * spacing;
    const double aligned = std::max(0.0, std::cos(wrapped(wanted - m.heading_rad)));
    advance(wanted, std::min(speed * aligned, std::max(0.12, std::sqrt(2 * kAcceleration * 0.7 * left))));
    m.gesture_weight = std::max(0.0, m.gesture_weight - 2 * Walk::kStepS);
    along += m.speed * Walk::kStepS / spacing;
    const auto k = std::min(static_cast<std::size_t>(along), line.size() - 2);
    const double f = std::min(1.0, along - static_cast<double>(k));
    m.position = line[k] + f * (line[k + 1] - line[k]);
    walk.push(m);
  }
  const double look = random.uniform(-kPi, kPi);
  const auto gesture = static_cast<Gesture>(random.integer(kGestures));
  for (int i = 0; i < static_cast<int>(pause_s / Walk::kStepS); ++i) {
    advance(look, 0);
    if (m.gesture_weight <= 0) m.gesture = gesture;
    m.gesture_weight = m.gesture == gesture ? std::min(1.0, m.gesture_weight + 1.5 * Walk::kStepS)
                                            : std::max(0.0, m.gesture_weight - 2 * Walk::kStepS);
    walk.push(m);
  }
  return walk;
}

void WalkPlanner::walk_through(const Scene& scene) {
  Scene empty;
  for (const Room& room : scene.rooms) {
    rooms_.push_back(room.box);
    empty.rooms.push_back({room.box, {}, {}, {}});
  }
  empty.openings = scene.openings;
  sight_.emplace(empty, kThinWall);
}

Eigen::Vector2d WalkPlanner::draw_goal(double time_s, const Eigen::Vector2d& from, Random& random) const {
  if (rooms_.empty() || random.chance(kInViewProbability)) return goal_in_view(time_s, random);
  return goal_in_a_room(from, random);
}

/// In one of the rooms around: through a door or two.
Eigen::Vector2d WalkPlanner::goal_in_a_room(const Eigen::Vector2d& from, Random& random) const {
  std::vector<geometry::Box3> rooms = rooms_;
  std::ranges::sort(rooms, {},
                    [&](const geometry::Box3& box) { return (box.center().head<2>() - from).norm(); });
  const int choices = std::min(kRoomsAround, static_cast<int>(rooms.size()));
  const geometry::Box3& room = rooms[static_cast<std::size_t>(random.integer(choices))];
  const Eigen::Vector2d share(random.uniform(0.2, 0.8), random.uniform(0.2, 0.8));
  return floor_.nearest_free(room.min.head<2>() + room.size().head<2>().cwiseProduct(share));
}

Eigen::Vector2d WalkPlanner::goal_in_view(double time_s, Random& random) const {
  const geometry::Pose camera = world_from_camera_(std::min(time_s + 3, seconds_));
  const Eigen::Vector2d forward = camera.linear().col(2).head<2>().normalized();
  const Eigen::Vector2d right(forward.y(), -forward.x());
  const double half_view = camera_.width / 2.0 / camera_.fx;
  const double depth = random.uniform(1.15, 2.9);
  const double side =
      random.chance(0.45) ? random.uniform(-0.7, 0.7) : random.sign() * random.uniform(1.2, 1.9);
  return floor_.nearest_free(camera.translation().head<2>() + depth * forward +
                             side * depth * half_view * right);
}

double WalkPlanner::coverage(const Eigen::Vector2d& position, const geometry::Pose& camera_from_world) const {
  const Eigen::Vector3d feet = camera_from_world * Eigen::Vector3d(position.x(), position.y(), 0);
  const Eigen::Vector3d crown = camera_from_world * Eigen::Vector3d(position.x(), position.y(), 1.75);
  const double z = (feet.z() + crown.z()) / 2;
  if (z < 0.3) return 0;
  const Eigen::Vector2d a = camera_.project({feet.x(), feet.y(), std::max(feet.z(), 0.2)});
  const Eigen::Vector2d b = camera_.project({crown.x(), crown.y(), std::max(crown.z(), 0.2)});
  const double half = 0.22 * camera_.fx / z;
  const double x = (a.x() + b.x()) / 2;
  const double width =
      std::clamp(x + half, 0.0, 1.0 * camera_.width) - std::clamp(x - half, 0.0, 1.0 * camera_.width);
  const double height =
      std::clamp(a.y(), 0.0, 1.0 * camera_.height) - std::clamp(b.y(), 0.0, 1.0 * camera_.height);
  return 0.7 * width * std::max(0.0, height) / (camera_.width * camera_.height);
}

double WalkPlanner::score(const Walk& walk, double start_s) const {
  if (walk.empty()) return -1e6;
  double sum = 0;
  int count = 0;
  for (double t = 0; t < std::min(walk.duration_s(), seconds_ - start_s); t += kPlanningStepS, ++count) {
    const Eigen::Vector2d p = walk.at(t).position;
    const geometry::Pose camera = world_from_camera_(start_s + t);
    const geometry::Pose camera_from_world = camera.inverse();
    const bool hidden = sight_ && !sight_->is_clear(camera.translation().head<2>(), p);
    const double cover = hidden ? 0 : coverage(p, camera_from_world);
    double together = cover;
    sum += std::min(cover, kWantedCover) / kWantedCover;
    sum -= 20 * std::max(0.0, kCameraRoom - (camera.translation().head<2>() - p).norm());
    for (const auto& other : others_) {
      const Eigen::Vector2d q = other.at(start_s + t).position;
      together += coverage(q, camera_from_world);
      sum -= 20 * std::max(0.0, kPersonRoom - (q - p).norm());
    }
    sum -= 6 * std::max(0.0, together - 0.42);
  }
  return sum / std::max(1, count);
}

Motion WalkPlanner::enter(double speed, Random& random) const {
  Motion best;
  double best_score = -1e9;
  for (int i = 0; i < 24; ++i) {
    Motion m;
    m.position = draw_goal(-3, world_from_camera_(0).translation().head<2>(), random);
    m.heading_rad = random.uniform(-kPi, kPi);
    m.phase_rad = random.uniform(0, 2 * kPi);
    m.speed = speed * random.uniform(0, 0.5);
    Walk still;
    for (int k = 0; k < 30; ++k) still.push(m);
    const double value = score(still, 0);
    if (value <= best_score) continue;
    best_score = value;
    best = m;
  }
  return best;
}

Walk WalkPlanner::plan(double speed, Random random) {
  Walk walk;
  walk.push(enter(speed, random));
  while (walk.duration_s() < seconds_ + 0.1) {
    Walk best;
    double best_score = -1e9;
    for (int i = 0; i < (rooms_.empty() ? kWays : kWaysOnFloor); ++i) {
      const Eigen::Vector2d goal =
          i == 0 ? walk.last().position : draw_goal(walk.duration_s(), walk.last().position, random);
      const double pause = i == 0 ? 0.8 : (random.chance(0.4) ? 0.0 : random.uniform(0.6, 3.0));
      const Walk candidate = leg(walk.last(), goal, speed * random.uniform(0.85, 1.1), pause, random);
      const double value =
          score(candidate, walk.duration_s()) + random.uniform(0, rooms_.empty() ? kWhim : kWhimOnFloor);
      if (value <= best_score) continue;
      best_score = value;
      best = candidate;
    }
    walk.append(best);
  }
  walk.truncate(static_cast<std::size_t>(seconds_ / Walk::kStepS) + 2);
  others_.push_back(walk);
  return walk;
}

}  // namespace rds::simulator
