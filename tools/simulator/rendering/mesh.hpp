// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "tools/simulator/rendering/texture.hpp"

namespace rds::simulator {

/// A corner of a triangle; positions and normals in the world [m], light is what falls on it (B, G, R; about
/// 1).
struct Vertex {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();
  Eigen::Vector2f uv = Eigen::Vector2f::Zero();
  Eigen::Array3f light = Eigen::Array3f::Ones();
};

/// Counter-clockwise when seen from outside.
struct Triangle {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  std::uint32_t c = 0;
  std::uint16_t material = 0;
  std::uint16_t object = 0;
};

struct Mesh {
  std::vector<Vertex> vertices;
  std::vector<Triangle> triangles;
};

/// What a surface looks like, to the colour camera and to the infrared depth camera.
struct Material {
  std::size_t texture = 0;
  Eigen::Array3f tint = Eigen::Array3f::Ones();
  float infrared = 1;          // share of the infrared pattern that comes back; below .5 depth drops out
  bool takes_shadows = false;  // people's soft shadows fall on it (floor, carpet)
  float emission = 0;          // light of its own (screens, lamps, windows)
};

/// The look of everything: triangles refer to materials, materials to textures.
struct Appearance {
  std::vector<Texture> textures;
  std::vector<Material> materials;
};

/// Which part of a texture a shape shows: metres per repetition, or one rectangle stretched over each face.
struct TextureMapping {
  float metres = 0.5F;  // ≤ 0: stretch `u0 … v1` over the face
  float u0 = 0;
  float v0 = 0;
  float u1 = 1;
  float v1 = 1;
  static TextureMapping fit(float u0 = 0, float v0 = 0, float u1 = 1, float v1 = 1) {
    return {-1, u0, v0, u1, v1};
  }
};

/// Identity of what is being added to a mesh.
struct Surface {
  std::uint16_t material = 0;
  std::uint16_t object = 0;
};

/// Rectangle corner + s·right + t·down, s, t in 0 … 1, facing right × (−down), cut into cells ≤ `cell` [m].
void add_quad(Mesh& mesh, const Eigen::Vector3f& corner, const Eigen::Vector3f& right,
              const Eigen::Vector3f& down, const TextureMapping& mapping, Surface surface,
              float cell = 0.15F);

/// Box with full edge lengths `size` around the origin of `world_from_box`; all six faces.
void add_box(Mesh& mesh, const Eigen::Isometry3f& world_from_box, const Eigen::Vector3f& size,
             const TextureMapping& mapping, Surface surface, float cell = 0.15F);

/// One cross-section of a loft: points centre + cos·side + sin·front, as superellipse of `exponent` (2 =
/// ellipse).
struct Ring {
  Eigen::Vector3f center = Eigen::Vector3f::Zero();
  Eigen::Vector3f side = Eigen::Vector3f::UnitX();
  Eigen::Vector3f front = Eigen::Vector3f::UnitY();
  float v = 0;  // texture coordinate along the loft
  float exponent = 2;
};

/// Closed skin over consecutive rings with smooth normals; u runs around once × `repeat_u`. Rings go upwards
/// when side × front points up.
void add_loft(Mesh& mesh, std::span<const Ring> rings, int segments, Surface surface, float repeat_u = 1);

/// Ellipsoid with half axes along the columns of `axes`; u around (0.5 = +first axis), v from top 0 to
/// bottom 1.
void add_ellipsoid(Mesh& mesh, const Eigen::Vector3f& center, const Eigen::Matrix3f& axes, int segments,
                   Surface surface);

/// Turned body: (radius, height) pairs from bottom to top around the z axis of `world_from_lathe`.
void add_lathe(Mesh& mesh, const Eigen::Isometry3f& world_from_lathe,
               std::span<const Eigen::Vector2f> profile, int segments, Surface surface, float repeat_u = 1);

}  // namespace rds::simulator
