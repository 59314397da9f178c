// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/people/gait.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rds::simulator {
namespace {

using Eigen::AngleAxisf;
using Eigen::Vector3f;

/// Angles of one arm: swing forward, away from the body, elbow, and turn of the forearm across the chest.
struct ArmAngles {
  float swing = 0;
  float away = 0.085F;
  float elbow = 0.2F;
  float inward = 0;
};

ArmAngles blend(const ArmAngles& a, const ArmAngles& b, float t) {
  const auto mix = [t](float x, float y) { return x + (y - x) * t; };
  return {mix(a.swing, b.swing), mix(a.away, b.away), mix(a.elbow, b.elbow), mix(a.inward, b.inward)};
}

ArmAngles gesture_angles(Gesture gesture, bool left, float time) {
  const float sway = std::sin(time * 2.6F + (left ? 0.7F : 0.0F));
  switch (gesture) {
    case Gesture::kPhone:
      return left ? ArmAngles{} : ArmAngles{0.55F, 0.35F, 2.35F, 0.35F};
    case Gesture::kCrossed:
      return {0.45F, 0.1F, 1.75F + (left ? 0.12F : 0.0F), 1.1F};
    case Gesture::kHandOnHip:
      return left ? ArmAngles{-0.25F, 0.75F, 1.75F, 1.0F} : ArmAngles{};
    case Gesture::kTalk:
      return {0.35F + 0.2F * sway, 0.2F, 1.35F + 0.35F * sway, 0.3F};
    case Gesture::kCarry:
      return {0.35F, 0.1F, 1.25F, 0.35F};
    case Gesture::kHang:
      break;
  }
  return {};
}

Limb bend_arm(const Vector3f& shoulder, const Eigen::Matrix3f& axes, float side, const ArmAngles& angles,
              float height) {
  const float upper_length = 0.165F * height;
  const float lower_length = 0.148F * height;
  const Vector3f down(std::sin(angles.swing) * std::cos(angles.away), side * std::sin(angles.away),
                      -std::cos(angles.swing) * std::cos(angles.away));
  const Vector3f front(std::cos(angles.swing), 0, std::sin(angles.swing));
  const Vector3f towards =
      (front * std::cos(angles.inward) + Vector3f(0, -side, 0) * std::sin(angles.inward)).normalized();
  const Vector3f lower = (down * std::cos(angles.elbow) + towards * std::sin(angles.elbow)).normalized();
  const Vector3f lower_front =
      (towards * std::cos(angles.elbow) - down * std::sin(angles.elbow)).normalized();
  Limb limb;
  limb.root = shoulder;
  limb.middle = shoulder + axes * down * upper_length;
  limb.end = limb.middle + axes * lower * lower_length;
  limb.upper_front = axes * front;
  limb.lower_front = axes * lower_front;
  return limb;
}

Limb bend_leg(const Vector3f& hip, const Eigen::Matrix3f& axes, float thigh, float knee, float splay,
              float height) {
  const auto direction = [&](float angle) {
    return Vector3f(axes * Vector3f(std::sin(angle), splay, -std::cos(angle)).normalized());
  };
  const auto front = [&](float angle) {
    return Vector3f(axes * Vector3f(std::cos(angle), 0, std::sin(angle)));
  };
  Limb limb;
  limb.root = hip;
  limb.middle = hip + direction(thigh) * (0.245F * height);
  limb.end = limb.middle + direction(thigh - knee) * (0.235F * height);
  limb.upper_front = front(thigh);
  limb.lower_front = front(thigh - knee);
  return limb;
}

Eigen::Matrix3f turned(float yaw, float lean = 0) {
  return (AngleAxisf(yaw, Vector3f::UnitZ()) * AngleAxisf(lean, Vector3f::UnitY())).toRotationMatrix();
}

/// Legs and pelvis height; returns how much the gait moves (0 standing … 1 brisk).
float place_legs(const BodyShape& body, const Motion& motion, Skeleton& out) {
  const float h = body.height;
  const float leg = 0.48F * h;
  const auto speed = static_cast<float>(motion.speed);
  const float amount = std::clamp(speed / 0.5F, 0.0F, 1.0F);
  const float reach =
      std::asin(std::min(0.6F, static_cast<float>(stride_length(motion.speed, h)) / (4 * leg))) * amount;
  const auto phase = static_cast<float>(motion.phase_rad);
  float lowest = 1e9F;
  for (std::size_t i = 0; i < 2; ++i) {
    const float side = i == 0 ? 1.0F : -1.0F;
    const float angle = phase + (i == 0 ? 0.0F : std::numbers::pi_v<float>);
    const float thigh = reach * (std::sin(angle) + 0.12F);
    const float swing = std::max(0.0F, std::cos(angle) + 0.2F);
    const float knee = 0.05F + amount * 0.08F + reach * 1.9F * std::pow(swing, 1.4F) * 0.8F;
    const Vector3f hip =
        out.pelvis + out.pelvis_axes * Vector3f(0, side * 0.052F * h * std::sqrt(body.girth), 0);
    out.legs[i] = bend_leg(hip, out.pelvis_axes, thigh, knee, side * (0.045F - 0.03F * amount), h);
    const float pitch = 0.55F * std::min(0.0F, thigh - knee + 0.1F) + 0.35F * std::max(0.0F, thigh - 0.15F);
    out.toes[i] = out.pelvis_axes * Vector3f(std::cos(pitch), side * 0.12F, std::sin(pitch)).normalized();
    const float toe_drop = std::max(0.0F, -out.toes[i].z()) * 0.11F * h;
    lowest = std::min(lowest, out.legs[i].end.z() - toe_drop);
  }
  const Vector3f lift(0, 0, 0.043F * h - lowest);
  out.pelvis += lift;
  for (auto& limb : out.legs)
    for (Vector3f* joint : {&limb.root, &limb.middle, &limb.end}) *joint += lift;
  return amount;
}

}  // namespace

double stride_length(double speed, float body_height) {
  return static_cast<double>(body_height) * (0.34 + 0.42 * std::clamp(speed, 0.0, 2.0));
}

Skeleton pose_skeleton(const BodyShape& body, const Motion& motion) {
  const float h = body.height;
  const auto time = static_cast<float>(motion.time_s);
  const float swing = std::sin(static_cast<float>(motion.phase_rad));
  const float amount = std::clamp(static_cast<float>(motion.speed) / 0.5F, 0.0F, 1.0F);
  const auto heading = static_cast<float>(motion.heading_rad);
  Skeleton out;
  out.pelvis_axes = turned(heading - 0.07F * amount * swing);
  out.chest_axes = turned(heading + 0.12F * amount * swing + 0.03F * std::sin(time * 0.9F) * (1 - amount),
                          0.03F + 0.03F * amount);
  out.head_axes = turned(heading + 0.25F * std::sin(time * 0.55F) * (1 - 0.6F * amount),
                         0.05F + 0.05F * std::sin(time * 0.8F));
  out.pelvis =
      Vector3f(static_cast<float>(motion.position.x()), static_cast<float>(motion.position.y()), 0.52F * h);
  place_legs(body, motion, out);
  out.chest = out.pelvis + out.chest_axes * Vector3f(0, 0, 0.275F * h);
  out.head = out.chest + out.chest_axes * Vector3f(0.012F * h, 0, 0.135F * h);
  for (std::size_t i = 0; i < 2; ++i) {
    const float side = i == 0 ? 1.0F : -1.0F;
    const float back = (i == 0 ? -swing : swing) * amount * body.arm_swing;
    const ArmAngles walking{0.45F * back + 0.03F * std::sin(time + side), 0.055F + 0.03F * body.girth,
                            0.22F + 0.3F * std::max(0.0F, back), 0.15F};
    const ArmAngles angles = blend(walking, gesture_angles(motion.gesture, i == 0, time),
                                   static_cast<float>(motion.gesture_weight));
    const Vector3f shoulder =
        out.chest + out.chest_axes * Vector3f(0, side * 0.104F * h * body.shoulders, 0.001F * h);
    out.arms[i] = bend_arm(shoulder, out.chest_axes, side, angles, h);
  }
  return out;
}

}  // namespace rds::simulator
