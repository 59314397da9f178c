// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Geometry>

namespace rds::simulator {

/// What arms do while a person stands.
enum class Gesture : std::uint8_t { kHang, kPhone, kCrossed, kHandOnHip, kTalk, kCarry };
inline constexpr int kGestures = 6;

/// What a person does at one moment.
struct Motion {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  // on the floor [m]
  double heading_rad = 0;                              // 0 = +x
  double speed = 0;                                    // [m/s]
  double phase_rad = 0;                                // of the gait; 2π = two steps
  Gesture gesture = Gesture::kHang;
  double gesture_weight = 0;  // 0 … 1
  double time_s = 0;          // drives breathing and small movements
};

/// Proportions of one body.
struct BodyShape {
  float height = 1.75F;  // [m]
  float girth = 1;       // of trunk and limbs, 1 = slim adult
  float shoulders = 1;
  float arm_swing = 1;
};

/// Joint chain of one limb with the direction its front looks along; positions in the world [m].
struct Limb {
  Eigen::Vector3f root;
  Eigen::Vector3f middle;
  Eigen::Vector3f end;
  Eigen::Vector3f upper_front;
  Eigen::Vector3f lower_front;
};

/// A posed skeleton in the world; axes are (forward, left, up).
struct Skeleton {
  Eigen::Vector3f pelvis;
  Eigen::Vector3f chest;
  Eigen::Vector3f head;
  Eigen::Matrix3f pelvis_axes;
  Eigen::Matrix3f chest_axes;
  Eigen::Matrix3f head_axes;
  std::array<Limb, 2> legs;             // left, right; ends are ankles
  std::array<Limb, 2> arms;             // ends are wrists
  std::array<Eigen::Vector3f, 2> toes;  // direction of each foot, unit
};

/// Length of two steps at a walking speed [m]: longer steps when faster.
double stride_length(double speed, float body_height);

/// Bends the joints for this moment; the lower foot stands on the floor.
Skeleton pose_skeleton(const BodyShape& body, const Motion& motion);

}  // namespace rds::simulator
