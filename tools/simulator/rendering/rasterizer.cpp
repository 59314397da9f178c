// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/rendering/rasterizer.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace rds::simulator {
namespace {

constexpr double kNear = 0.05;

/// Part of the triangle in front of the near plane: 0, 3 or 4 corners.
int clip_near(const std::array<Eigen::Vector3d, 3>& in, std::array<Eigen::Vector3d, 4>& out) {
  int count = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& a = in[i];
    const auto& b = in[(i + 1) % 3];
    const bool a_in = a.z() > kNear;
    if (a_in) out[static_cast<std::size_t>(count++)] = a;
    if (a_in != (b.z() > kNear))
      out[static_cast<std::size_t>(count++)] = a + (b - a) * ((kNear - a.z()) / (b.z() - a.z()));
  }
  return count;
}

}  // namespace

Rasterizer::Rasterizer(const geometry::CameraModel& camera)
    : width_(2 * camera.width),
      height_(2 * camera.height),
      fx_(static_cast<float>(camera.fx)),
      fy_(static_cast<float>(camera.fy)),
      cx_(static_cast<float>(camera.cx)),
      cy_(static_cast<float>(camera.cy)),
      inverse_z_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)),
      id_(inverse_z_.size()) {}

void Rasterizer::clear() {
  std::fill(inverse_z_.begin(), inverse_z_.end(), 0.0F);
  std::fill(id_.begin(), id_.end(), 0U);
  triangles_.clear();
}

Eigen::Vector2d Rasterizer::to_sample(const Eigen::Vector3d& p) const {
  // Sample s covers pixel positions around s/2 − 1/4, so its own coordinate is 2·pixel + 1/2; +1/2 again for
  // edges.
  return {2 * (static_cast<double>(fx_) * p.x() / p.z() + static_cast<double>(cx_)) + 1.0,
          2 * (static_cast<double>(fy_) * p.y() / p.z() + static_cast<double>(cy_)) + 1.0};
}

void Rasterizer::draw(const Mesh& mesh, const geometry::Pose& camera_from_world) {
  in_camera_.resize(mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    in_camera_[i] = camera_from_world * mesh.vertices[i].position.cast<double>();
  for (const auto& triangle : mesh.triangles) draw_triangle(mesh, triangle);
}

void Rasterizer::draw_triangle(const Mesh& mesh, const Triangle& triangle) {
  const std::array<Eigen::Vector3d, 3> p{in_camera_[triangle.a], in_camera_[triangle.b],
                                         in_camera_[triangle.c]};
  if (p[0].z() <= kNear && p[1].z() <= kNear && p[2].z() <= kNear) return;
  const Eigen::Vector3d normal = (p[1] - p[0]).cross(p[2] - p[0]);
  const double volume = normal.dot(p[0]);
  if (volume > -1e-12) return;  // seen from behind or from the edge
  std::array<Eigen::Vector3d, 4> clipped;
  const int count = clip_near(p, clipped);
  std::array<Eigen::Vector2d, 4> corners;
  Eigen::AlignedBox2d box;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
    box.extend(corners[i] = to_sample(clipped[i]));
  if (box.max().x() <= 0 || box.max().y() <= 0 || box.min().x() >= width_ || box.min().y() >= height_) return;

  // Rows of the inverse of [a b c]: barycentric coordinates over z, as functions of the ray.
  const Eigen::Vector3d a = p[1].cross(p[2]) / volume;
  const Eigen::Vector3d b = p[2].cross(p[0]) / volume;
  const Eigen::Vector3d c = p[0].cross(p[1]) / volume;
  const auto mix = [&](double fa, double fb, double fc) {
    return Eigen::Vector3f((a * fa + b * fb + c * fc).cast<float>());
  };
  const Vertex& va = mesh.vertices[triangle.a];
  const Vertex& vb = mesh.vertices[triangle.b];
  const Vertex& vc = mesh.vertices[triangle.c];
  VisibleTriangle visible;
  visible.inverse_z = (normal / volume).cast<float>();
  visible.u_over_z = mix(va.uv.x(), vb.uv.x(), vc.uv.x());
  visible.v_over_z = mix(va.uv.y(), vb.uv.y(), vc.uv.y());
  for (int i = 0; i < 3; ++i)
    visible.light_over_z.row(i) = mix(va.light[i], vb.light[i], vc.light[i]).transpose();
  visible.material = triangle.material;
  visible.object = triangle.object;
  triangles_.push_back(visible);
  scan(corners.data(), count, visible.inverse_z, static_cast<std::uint32_t>(triangles_.size()));
}

void Rasterizer::scan(const Eigen::Vector2d* corners, int count, const Eigen::Vector3f& inverse_z,
                      std::uint32_t id) {
  double top = corners[0].y();
  double bottom = top;
  for (int i = 1; i < count; ++i) {
    top = std::min(top, corners[i].y());
    bottom = std::max(bottom, corners[i].y());
  }
  const int first = static_cast<int>(std::ceil(std::clamp(top, 0.0, 1.0 * height_) - 0.5));
  const int last = static_cast<int>(std::ceil(std::clamp(bottom, 0.0, 1.0 * height_) - 0.5));
  const float step = inverse_z.x() * 0.5F / fx_;
  for (int y = first; y < last; ++y) {
    const double middle = y + 0.5;
    double left = 1e9;
    double right = -1e9;
    for (int i = 0; i < count; ++i) {
      const Eigen::Vector2d* low = &corners[i];
      const Eigen::Vector2d* high = &corners[i + 1 == count ? 0 : i + 1];
      if (low->y() > high->y()) std::swap(low, high);  // the same crossing for both triangles at an edge
      if (middle < low->y() || middle >= high->y()) continue;
      const double x = low->x() + (middle - low->y()) * ((high->x() - low->x()) / (high->y() - low->y()));
      left = std::min(left, x);
      right = std::max(right, x);
    }
    const int begin = static_cast<int>(std::ceil(std::clamp(left, 0.0, 1.0 * width_) - 0.5));
    const int end = static_cast<int>(std::ceil(std::clamp(right, 0.0, 1.0 * width_) - 0.5));
    const float at_zero =
        inverse_z.x() * ray_x(0) + inverse_z.y() * ray_y(static_cast<float>(y)) + inverse_z.z();
    const std::size_t row = index(0, y);
    for (int x = begin; x < end; ++x) {
      const float w = at_zero + step * static_cast<float>(x);
      float& nearest = inverse_z_[row + static_cast<std::size_t>(x)];
      if (w > nearest) {
        nearest = w;
        id_[row + static_cast<std::size_t>(x)] = id;
      }
    }
  }
}

}  // namespace rds::simulator
