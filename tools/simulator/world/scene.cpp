// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/world/scene.hpp"

#include <algorithm>
#include <utility>

namespace rds::simulator {
namespace {

constexpr float kCell = 0.12F;  // lighting is stored per vertex, so this is its resolution [m]

void add(const Eigen::Vector3d& point, geometry::Box3& box) {
  box.min = box.min.cwiseMin(point);
  box.max = box.max.cwiseMax(point);
}

}  // namespace

Eigen::Vector3d SceneObject::center_when_turned() const {
  return Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()) * box_when_turned.center();
}

geometry::Box3 Scene::bounds() const {
  geometry::Box3 bounds = rooms.front().box;
  for (const Room& room : rooms) {
    bounds.min = bounds.min.cwiseMin(room.box.min);
    bounds.max = bounds.max.cwiseMax(room.box.max);
  }
  return bounds;
}

std::size_t Scene::room_at(const Eigen::Vector3d& point) const {
  const auto nearest =
      std::ranges::min_element(rooms, {}, [&](const Room& room) { return room.distance(point); });
  return static_cast<std::size_t>(nearest - rooms.begin());
}

void SceneBuilder::begin_room(const geometry::Box3& box, std::vector<Lamp> lamps) {
  scene_.rooms.push_back({box, std::move(lamps), {}, {}});
  begin_building();
}

std::uint16_t SceneBuilder::material(const cv::Mat& picture, const Material& look) {
  Material material = look;
  material.texture = scene_.appearance.textures.size();
  scene_.appearance.textures.emplace_back(picture);
  scene_.appearance.materials.push_back(material);
  return static_cast<std::uint16_t>(scene_.appearance.materials.size() - 1);
}

void SceneBuilder::begin(const std::string& label, float x, float y, float z, float yaw_rad) {
  object_ = static_cast<std::uint16_t>(scene_.objects.size());
  scene_.objects.push_back({label, double{yaw_rad}});
  world_from_object_ = Eigen::Translation3f(x, y, z) * Eigen::AngleAxisf(yaw_rad, Eigen::Vector3f::UnitZ());
}

void SceneBuilder::begin_building() {
  object_ = 0;
  world_from_object_ = Eigen::Isometry3f::Identity();
}

void SceneBuilder::finish_shape(std::size_t first_vertex) {
  SceneObject& object = scene_.objects[object_];
  const Eigen::AngleAxisd turned_from_world(-object.yaw_rad, Eigen::Vector3d::UnitZ());
  for (std::size_t i = first_vertex; i < room().mesh.vertices.size(); ++i) {
    const Eigen::Vector3d p = room().mesh.vertices[i].position.cast<double>();
    add(p, object.box);
    add(turned_from_world * p, object.box_when_turned);
  }
}

void SceneBuilder::box(const Eigen::Vector3f& center, const Eigen::Vector3f& size, std::uint16_t material,
                       const TextureMapping& mapping) {
  box(Eigen::Isometry3f(Eigen::Translation3f(center)), size, material, mapping);
}

void SceneBuilder::box(const Eigen::Isometry3f& object_from_box, const Eigen::Vector3f& size,
                       std::uint16_t material, const TextureMapping& mapping) {
  const std::size_t first = room().mesh.vertices.size();
  const Eigen::Isometry3f world_from_box = world_from_object_ * object_from_box;
  add_box(room().mesh, world_from_box, size, mapping, surface(material), kCell);
  room().occluders.push_back({world_from_box, size / 2, object_});
  finish_shape(first);
}

void SceneBuilder::panel(const Eigen::Vector3f& center, const Eigen::Vector3f& right,
                         const Eigen::Vector3f& up, std::uint16_t material, const TextureMapping& mapping) {
  const std::size_t first = room().mesh.vertices.size();
  const Eigen::Matrix3f& turn = world_from_object_.linear();
  add_quad(room().mesh, world_from_object_ * Eigen::Vector3f(center - right / 2 + up / 2), turn * right,
           turn * -up, mapping, surface(material), kCell);
  finish_shape(first);
}

void SceneBuilder::lathe(const Eigen::Vector3f& base, std::vector<Eigen::Vector2f> profile,
                         std::uint16_t material, int segments, float repeat_u) {
  const std::size_t first = room().mesh.vertices.size();
  const Eigen::Isometry3f pose = world_from_object_ * Eigen::Translation3f(base);
  add_lathe(room().mesh, pose, profile, segments, surface(material), repeat_u);
  float radius = 0;
  for (const auto& p : profile) radius = std::max(radius, p.x());
  const float low = profile.front().y();
  const float high = profile.back().y();
  room().occluders.push_back({pose * Eigen::Translation3f(0, 0, (low + high) / 2),
                              Eigen::Vector3f(radius * 0.8F, radius * 0.8F, std::abs(high - low) / 2),
                              object_});
  finish_shape(first);
}

void SceneBuilder::ellipsoid(const Eigen::Vector3f& center, const Eigen::Vector3f& half,
                             std::uint16_t material) {
  const std::size_t first = room().mesh.vertices.size();
  add_ellipsoid(room().mesh, world_from_object_ * center, world_from_object_.linear() * half.asDiagonal(), 16,
                surface(material));
  room().occluders.push_back({world_from_object_ * Eigen::Translation3f(center), half * 0.7F, object_});
  finish_shape(first);
}

void SceneBuilder::loft(std::vector<Ring> rings, int segments, std::uint16_t material) {
  const std::size_t first = room().mesh.vertices.size();
  for (auto& ring : rings) {
    ring.center = world_from_object_ * ring.center;
    ring.side = world_from_object_.linear() * ring.side;
    ring.front = world_from_object_.linear() * ring.front;
  }
  add_loft(room().mesh, rings, segments, surface(material));
  finish_shape(first);
}

}  // namespace rds::simulator
