// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "common/geometry/camera_model.hpp"
#include "common/geometry/pose.hpp"
#include "tools/simulator/rendering/mesh.hpp"

namespace rds::simulator {

/// A triangle that reached the picture. Every attribute f is linear on its plane, so f/z is linear over the
/// picture: f = (f_over_z · r) / (inverse_z · r) for the ray r = (x, y, 1).
struct VisibleTriangle {
  Eigen::Vector3f inverse_z;
  Eigen::Vector3f u_over_z;
  Eigen::Vector3f v_over_z;
  Eigen::Matrix3f light_over_z;  // row per channel
  std::uint16_t material = 0;
  std::uint16_t object = 0;
};

/// Depth buffer at two by two samples per pixel; knows shapes, not colours.
class Rasterizer {
 public:
  /// @param camera  without distortion.
  explicit Rasterizer(const geometry::CameraModel& camera);

  void clear();
  /// Draws the front faces of a mesh given in world coordinates.
  void draw(const Mesh& mesh, const geometry::Pose& camera_from_world);

  /// 1 + index into triangles() of what sample (x, y) of the doubled picture sees; 0 for nothing.
  [[nodiscard]] std::uint32_t at(int x, int y) const { return id_[index(x, y)]; }
  [[nodiscard]] const std::vector<VisibleTriangle>& triangles() const { return triangles_; }
  /// Rays (x or y, with z = 1) through the middle of sample columns and rows.
  [[nodiscard]] float ray_x(float sample_x) const { return (sample_x * 0.5F - 0.25F - cx_) / fx_; }
  [[nodiscard]] float ray_y(float sample_y) const { return (sample_y * 0.5F - 0.25F - cy_) / fy_; }
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }

 private:
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }
  void draw_triangle(const Mesh& mesh, const Triangle& triangle);
  void scan(const Eigen::Vector2d* corners, int count, const Eigen::Vector3f& inverse_z, std::uint32_t id);
  [[nodiscard]] Eigen::Vector2d to_sample(const Eigen::Vector3d& point_in_camera) const;

  int width_;  // of the doubled picture
  int height_;
  float fx_, fy_, cx_, cy_;
  std::vector<float> inverse_z_;
  std::vector<std::uint32_t> id_;
  std::vector<Eigen::Vector3d> in_camera_;
  std::vector<VisibleTriangle> triangles_;
};

}  // namespace rds::simulator
