// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/world/lighting.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <opencv2/core/utility.hpp>

namespace rds::simulator {
namespace {

using Eigen::Array3f;
using Eigen::Vector3f;

const Array3f kAmbientSky(0.52F, 0.50F, 0.50F);  // B, G, R
const Array3f kAmbientFloor(0.33F, 0.36F, 0.39F);
constexpr float kOcclusionRange = 0.9F;

/// Lambert with a distance law that stays finite near the lamp.
float received(const Vector3f& to_light, const Vector3f& normal) {
  const float square = to_light.squaredNorm();
  const float cosine = normal.dot(to_light) / std::sqrt(std::max(square, 1e-6F));
  return std::max(0.0F, cosine) / (0.9F + 0.32F * square);
}

Array3f ambient(const Vector3f& normal) {
  const float up = 0.5F + 0.5F * normal.z();
  return kAmbientSky * up + kAmbientFloor * (1 - up);
}

/// Things grouped by object, so that most rays cost a few box tests.
class OccluderIndex {
 public:
  explicit OccluderIndex(const Room& room) {
    for (const auto& occluder : room.occluders) {
      if (occluder.object != last_ || groups_.empty()) groups_.emplace_back();
      last_ = occluder.object;
      const Eigen::Isometry3f box_from_world = occluder.world_from_box.inverse();
      groups_.back().boxes.push_back({box_from_world, occluder.half});
      for (int corner = 0; corner < 8; ++corner) {
        const Vector3f sign((corner & 1) != 0 ? 1.0F : -1.0F, (corner & 2) != 0 ? 1.0F : -1.0F,
                            (corner & 4) != 0 ? 1.0F : -1.0F);
        groups_.back().bounds.extend(occluder.world_from_box * Vector3f(sign.cwiseProduct(occluder.half)));
      }
    }
  }

  /// Numbers of the groups that a ray of length `range` from `origin` can reach.
  [[nodiscard]] std::vector<std::size_t> reachable(const Vector3f& origin, float range) const {
    std::vector<std::size_t> near;
    for (std::size_t i = 0; i < groups_.size(); ++i)
      if (groups_[i].bounds.squaredExteriorDistance(origin) < range * range) near.push_back(i);
    return near;
  }

  /// Distance to the first thing of these groups on the ray, at most `range`.
  [[nodiscard]] float hit(const std::vector<std::size_t>& candidates, const Vector3f& origin,
                          const Vector3f& direction, float range) const {
    float nearest = range;
    for (const std::size_t candidate : candidates) {
      const Group& group = groups_[candidate];
      if (slab(origin, direction, group.bounds.min(), group.bounds.max()) >= nearest) continue;
      for (const auto& box : group.boxes) {
        const float t =
            slab(box.box_from_world * origin, box.box_from_world.linear() * direction, -box.half, box.half);
        nearest = std::min(nearest, t);
      }
    }
    return nearest;
  }

 private:
  struct Box {
    Eigen::Isometry3f box_from_world;
    Vector3f half;
  };
  struct Group {
    Eigen::AlignedBox3f bounds;
    std::vector<Box> boxes;
  };

  /// Entry distance into an axis-aligned box; infinity if missed; 0 from inside.
  static float slab(const Vector3f& origin, const Vector3f& direction, const Vector3f& low,
                    const Vector3f& high) {
    float enter = 0;
    float leave = 1e9F;
    for (int i = 0; i < 3; ++i) {
      const float inverse = 1 / (std::abs(direction[i]) > 1e-7F ? direction[i] : 1e-7F);
      const float a = (low[i] - origin[i]) * inverse;
      const float b = (high[i] - origin[i]) * inverse;
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    return enter <= leave ? enter : 1e9F;
  }

  std::vector<Group> groups_;
  std::uint16_t last_ = 0;
};

/// Cosine-weighted directions around +z, the same for every vertex: no noise from vertex to vertex.
std::vector<Vector3f> hemisphere(int count) {
  std::vector<Vector3f> directions;
  for (int i = 0; i < count; ++i) {
    const float r = std::sqrt((static_cast<float>(i) + 0.5F) / static_cast<float>(count));
    const float a = 2.399963F * static_cast<float>(i);
    directions.emplace_back(r * std::cos(a), r * std::sin(a), std::sqrt(1 - r * r));
  }
  return directions;
}

float distance_to_shell(const Vector3f& origin, const Vector3f& direction, const geometry::Box3& box) {
  const Vector3f low = box.min.cast<float>();
  const Vector3f high = box.max.cast<float>();
  float nearest = 1e9F;
  for (int i = 0; i < 3; ++i)
    if (std::abs(direction[i]) > 1e-6F)
      nearest = std::min(nearest, ((direction[i] > 0 ? high[i] : low[i]) - origin[i]) / direction[i]);
  return std::max(nearest, 0.0F);
}

Array3f baked(const Vertex& vertex, const OccluderIndex& index, const Room& room,
              const std::vector<Vector3f>& directions) {
  const Vector3f origin = vertex.position + vertex.normal * 0.012F;
  const Eigen::Matrix3f turn =
      Eigen::Quaternionf::FromTwoVectors(Vector3f::UnitZ(), vertex.normal).toRotationMatrix();
  const auto near = index.reachable(origin, kOcclusionRange);
  const auto all = index.reachable(origin, 100);
  float open = 0;
  for (const auto& local : directions) {
    const Vector3f direction = turn * local;
    const float shell = distance_to_shell(origin, direction, room.box);
    const float t = std::min(index.hit(near, origin, direction, kOcclusionRange), shell);
    open += std::min(1.0F, 0.15F + 0.85F * t / kOcclusionRange);
  }
  Array3f light = ambient(vertex.normal) * (open / static_cast<float>(directions.size()));
  for (const Lamp& lamp : room.lamps)
    for (const float a : {-0.75F, 0.0F, 0.75F})
      for (const float b : {-0.6F, 0.6F}) {
        const Vector3f to_light = lamp.position + a * lamp.extent_a + b * lamp.extent_b - origin;
        const float lambert = received(to_light, vertex.normal);
        if (lambert <= 0) continue;
        const float distance = to_light.norm();
        if (index.hit(all, origin, to_light / distance, distance) >= distance)
          light += lamp.power * (lambert / 6);
      }
  return light;
}

void bake(Room& room, const std::vector<Material>& materials, const std::vector<Vector3f>& directions) {
  const OccluderIndex index(room);
  std::vector<float> emission(room.mesh.vertices.size(), 0);
  for (const auto& triangle : room.mesh.triangles)
    for (const auto v : {triangle.a, triangle.b, triangle.c})
      emission[v] = materials[triangle.material].emission;
  for (std::size_t i = 0; i < room.mesh.vertices.size(); ++i) {
    auto& vertex = room.mesh.vertices[i];
    const float own = emission[i];
    vertex.light =
        own >= 1 ? Array3f::Constant(own) : Array3f(baked(vertex, index, room, directions) * (1 - own) + own);
  }
}

}  // namespace

Array3f light_at(const Vector3f& position, const Vector3f& normal, std::span<const Lamp> lamps) {
  const float floor_occlusion = 0.72F + 0.28F * std::min(1.0F, position.z() / 0.6F);
  Array3f light = ambient(normal) * floor_occlusion;
  for (const Lamp& lamp : lamps) light += lamp.power * received(lamp.position - position, normal);
  return light;
}

void bake_light(Scene& scene) {
  const auto directions = hemisphere(32);
  cv::parallel_for_({0, static_cast<int>(scene.rooms.size())}, [&](const cv::Range& range) {
    for (int i = range.start; i < range.end; ++i)
      bake(scene.rooms[static_cast<std::size_t>(i)], scene.appearance.materials, directions);
  });
}

}  // namespace rds::simulator
