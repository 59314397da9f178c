// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/camera_path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "tools/simulator/rendering/random.hpp"

namespace rds::simulator {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;
constexpr std::array<std::pair<const char*, PathKind>, 5> kNames{{{"static", PathKind::kStatic},
                                                                  {"xyz", PathKind::kXyz},
                                                                  {"rpy", PathKind::kRpy},
                                                                  {"halfsphere", PathKind::kHalfsphere},
                                                                  {"loop", PathKind::kLoop}}};

double smooth_step(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * x * (x * (6 * x - 15) + 10);
}

}  // namespace

geometry::Pose look_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& target) {
  geometry::Pose pose = geometry::Pose::Identity();
  const Eigen::Vector3d z = (target - eye).normalized();
  const Eigen::Vector3d x = z.cross(Eigen::Vector3d::UnitZ()).normalized();
  pose.linear().col(0) = x;
  pose.linear().col(1) = z.cross(x);
  pose.linear().col(2) = z;
  pose.translation() = eye;
  return pose;
}

std::optional<PathKind> path_kind(const std::string& name) {
  for (const auto& [known, kind] : kNames)
    if (name == known) return kind;
  return std::nullopt;
}

std::string path_names() {
  std::string names;
  for (const auto& [name, kind] : kNames) {
    if (!names.empty()) names += '|';
    names += name;
  }
  return names;
}

CameraPath::CameraPath(PathKind kind, double seconds, std::uint64_t seed) : kind_(kind), seconds_(seconds) {
  Random random(seed, 2);
  eye_ = {random.uniform(-0.15, 0.15), random.uniform(-1.15, -0.95), random.uniform(1.3, 1.45)};
  target_ = {random.uniform(-0.1, 0.15), 2.0, random.uniform(0.95, 1.05)};
  for (auto& phase : phase_) phase = random.uniform(0, kTwoPi);
  for (auto& pace : pace_) pace = random.uniform(0.85, 1.18);
}

double CameraPath::tremor(int channel, double t) const {
  const auto c = static_cast<std::size_t>(channel);
  const double p = phase_[c];
  const double s = pace_[c];
  return 0.55 * std::sin(kTwoPi * 0.31 * s * t + p) + 0.3 * std::sin(kTwoPi * 0.83 * s * t + 2 * p) +
         0.1 * std::sin(kTwoPi * 2.1 * s * t + 3 * p) + 0.05 * std::sin(kTwoPi * 4.7 * s * t + 5 * p);
}

CameraPath::View CameraPath::view(double t) const {
  const auto wave = [&](std::size_t channel, double period) {
    return std::sin(kTwoPi * t / (period * pace_[channel]) + phase_[channel]);
  };
  View view{eye_, target_, Eigen::Vector3d::Zero()};
  switch (kind_) {
    case PathKind::kStatic:
      break;
    case PathKind::kXyz: {
      const Eigen::Vector3d shift(0.42 * wave(0, 6.5), 0.30 * wave(1, 8.3), 0.2 * wave(2, 5.2));
      view.eye += shift;
      view.target += shift;
      break;
    }
    case PathKind::kRpy:
      view.eye += Eigen::Vector3d(0.05 * wave(3, 5), 0.04 * wave(4, 7), 0.03 * wave(5, 4));
      view.turn = {0.20 * wave(0, 5.1), 0.36 * wave(1, 7.3), 0.30 * wave(2, 6.1)};
      break;
    case PathKind::kHalfsphere: {
      constexpr double kRadius = 0.5;
      const double azimuth = 1.15 * wave(0, 11);
      const double elevation = 0.55 + 0.5 * wave(1, 7.7);
      view.eye +=
          kRadius * Eigen::Vector3d(std::cos(elevation) * std::sin(azimuth),
                                    1 - std::cos(elevation) * std::cos(azimuth), std::sin(elevation)) -
          Eigen::Vector3d(0, 0, 0.3);
      view.turn = {0, 0, 0.12 * wave(2, 6)};
      break;
    }
    case PathKind::kLoop: {
      const double laps = std::max(1.0, std::round(seconds_ / 28.0));
      const double angle = kTwoPi * laps * smooth_step(t / (0.95 * seconds_)) - std::numbers::pi / 2;
      const double outward =
          angle + 0.95;  // a little ahead of the radius: the camera walks and looks where it goes
      view.eye = {1.0 * std::cos(angle), 0.85 * std::sin(angle), eye_.z() + 0.05 * wave(0, 5)};
      view.target = view.eye + Eigen::Vector3d(2 * std::cos(outward), 2 * std::sin(outward), -0.42);
      break;
    }
  }
  return view;
}

geometry::Pose CameraPath::world_from_camera(double t) const {
  const View v = view(t);
  const double calm = kind_ == PathKind::kStatic ? 0.6 : 1.0;
  const Eigen::Vector3d shake(tremor(0, t), tremor(1, t), tremor(2, t));
  geometry::Pose pose = look_at(v.eye + 0.012 * calm * shake, v.target);
  const double angle = 0.012 * calm;
  pose.rotate(Eigen::AngleAxisd(v.turn.y() + angle * tremor(3, t), Eigen::Vector3d::UnitY()));
  pose.rotate(Eigen::AngleAxisd(v.turn.x() + angle * tremor(4, t), Eigen::Vector3d::UnitX()));
  pose.rotate(Eigen::AngleAxisd(v.turn.z() + angle * tremor(5, t), Eigen::Vector3d::UnitZ()));
  return pose;
}

}  // namespace rds::simulator
