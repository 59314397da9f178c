// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/rendering/mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace rds::simulator {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

int cells(float length, float cell) {
  return std::clamp(static_cast<int>(std::ceil(length / cell)), 1, 120);
}

void add_cell(Mesh& mesh, std::uint32_t top_left, std::uint32_t row, Surface surface) {
  const std::uint32_t bottom_left = top_left + row;
  mesh.triangles.push_back({top_left, bottom_left, top_left + 1, surface.material, surface.object});
  mesh.triangles.push_back({top_left + 1, bottom_left, bottom_left + 1, surface.material, surface.object});
}

float superellipse(float x, float exponent) {
  if (exponent == 2) return x;
  return std::copysign(std::pow(std::abs(x), 2 / exponent), x);
}

}  // namespace

void add_quad(Mesh& mesh, const Eigen::Vector3f& corner, const Eigen::Vector3f& right,
              const Eigen::Vector3f& down, const TextureMapping& mapping, Surface surface, float cell) {
  const int columns = cells(right.norm(), cell);
  const int rows = cells(down.norm(), cell);
  const Eigen::Vector3f normal = right.cross(-down).normalized();
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int r = 0; r <= rows; ++r)
    for (int c = 0; c <= columns; ++c) {
      const float s = static_cast<float>(c) / static_cast<float>(columns);
      const float t = static_cast<float>(r) / static_cast<float>(rows);
      Vertex vertex;
      vertex.position = corner + s * right + t * down;
      vertex.normal = normal;
      if (mapping.metres > 0)
        vertex.uv = {mapping.u0 + s * right.norm() / mapping.metres,
                     mapping.v0 + t * down.norm() / mapping.metres};
      else
        vertex.uv = {mapping.u0 + s * (mapping.u1 - mapping.u0), mapping.v0 + t * (mapping.v1 - mapping.v0)};
      mesh.vertices.push_back(vertex);
    }
  const auto row = static_cast<std::uint32_t>(columns + 1);
  for (std::uint32_t r = 0; r < static_cast<std::uint32_t>(rows); ++r)
    for (std::uint32_t c = 0; c < static_cast<std::uint32_t>(columns); ++c)
      add_cell(mesh, first + r * row + c, row, surface);
}

void add_box(Mesh& mesh, const Eigen::Isometry3f& world_from_box, const Eigen::Vector3f& size,
             const TextureMapping& mapping, Surface surface, float cell) {
  const Eigen::Matrix3f axes = world_from_box.linear() * size.asDiagonal();
  const Eigen::Vector3f x = axes.col(0);
  const Eigen::Vector3f y = axes.col(1);
  const Eigen::Vector3f z = axes.col(2);
  const Eigen::Vector3f center = world_from_box.translation();
  // Each face: outward axis, then its right and up as seen from outside.
  const std::array<std::array<Eigen::Vector3f, 3>, 6> faces{
      {{-y, x, z}, {y, -x, z}, {x, y, z}, {-x, -y, z}, {z, x, y}, {-z, x, -y}}};
  for (const auto& [outward, right, up] : faces)
    add_quad(mesh, center + 0.5F * (outward - right + up), right, -up, mapping, surface, cell);
}

void add_loft(Mesh& mesh, std::span<const Ring> rings, int segments, Surface surface, float repeat_u) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const int count = static_cast<int>(rings.size());
  const auto point = [&](int ring, int segment) -> Eigen::Vector3f {
    const auto& r = rings[static_cast<std::size_t>(std::clamp(ring, 0, count - 1))];
    const float angle = 2 * kPi * static_cast<float>(segment % segments) / static_cast<float>(segments);
    return r.center + r.side * superellipse(std::cos(angle), r.exponent) +
           r.front * superellipse(std::sin(angle), r.exponent);
  };
  for (int i = 0; i < count; ++i)
    for (int k = 0; k <= segments; ++k) {
      Vertex vertex;
      vertex.position = point(i, k);
      const Eigen::Vector3f around = point(i, k + 1) - point(i, k + segments - 1);
      const Eigen::Vector3f along = point(i + 1, k) - point(i - 1, k);
      const Eigen::Vector3f normal = around.cross(along);
      const Eigen::Vector3f outward = vertex.position - rings[static_cast<std::size_t>(i)].center;
      vertex.normal = normal.norm() > 1e-9F
                          ? normal.normalized()
                          : (outward.norm() > 1e-9F ? outward.normalized() : along.normalized());
      vertex.uv = {repeat_u * static_cast<float>(k) / static_cast<float>(segments),
                   rings[static_cast<std::size_t>(i)].v};
      mesh.vertices.push_back(vertex);
    }
  const auto row = static_cast<std::uint32_t>(segments + 1);
  for (std::uint32_t i = 0; i + 1 < static_cast<std::uint32_t>(count); ++i)
    for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(segments); ++k) {
      const std::uint32_t low = first + i * row + k;
      mesh.triangles.push_back({low, low + 1, low + row, surface.material, surface.object});
      mesh.triangles.push_back({low + 1, low + row + 1, low + row, surface.material, surface.object});
    }
}

void add_ellipsoid(Mesh& mesh, const Eigen::Vector3f& center, const Eigen::Matrix3f& axes, int segments,
                   Surface surface) {
  const int bands = std::max(4, segments * 2 / 3);
  std::vector<Ring> rings;
  for (int i = 0; i <= bands; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(bands);
    const float radius = std::max(std::sin(kPi * t), 1e-3F);
    // The seam (u = 0) lies at the back.
    rings.push_back(
        {center - axes.col(2) * std::cos(kPi * t), -axes.col(0) * radius, -axes.col(1) * radius, 1 - t});
  }
  const std::size_t first = mesh.vertices.size();
  add_loft(mesh, rings, segments, surface);
  const Eigen::Matrix3f to_unit = axes.inverse();
  for (std::size_t i = first; i < mesh.vertices.size(); ++i)
    mesh.vertices[i].normal =
        (to_unit.transpose() * (to_unit * (mesh.vertices[i].position - center))).normalized();
}

void add_lathe(Mesh& mesh, const Eigen::Isometry3f& world_from_lathe,
               std::span<const Eigen::Vector2f> profile, int segments, Surface surface, float repeat_u) {
  std::vector<Ring> rings;
  const float bottom = profile.front().y();
  const float height = std::max(profile.back().y() - bottom, 1e-3F);
  for (const auto& p : profile) {
    const float radius = std::max(p.x(), 1e-4F);
    rings.push_back({world_from_lathe * Eigen::Vector3f(0, 0, p.y()),
                     world_from_lathe.linear().col(0) * radius, world_from_lathe.linear().col(1) * radius,
                     1 - (p.y() - bottom) / height});
  }
  add_loft(mesh, rings, segments, surface, repeat_u);
}

}  // namespace rds::simulator
