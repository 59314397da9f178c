// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "common/geometry/box.hpp"
#include "tools/simulator/rendering/mesh.hpp"

namespace rds::simulator {

/// Contains nothing, so that points can be added to it.
inline geometry::Box3 empty_box() {
  return {Eigen::Vector3d::Constant(1e9), Eigen::Vector3d::Constant(-1e9)};
}

/// A thing that stands in a room. Things without a label (books, lamps, walls) are not part of the truth.
struct SceneObject {
  std::string label;   // as in VOC: chair, tvmonitor, diningtable, sofa, pottedplant, bottle; or empty
  double yaw_rad = 0;  // of its own axes about the world's z axis
  geometry::Box3 box = empty_box();              // in the world [m]
  geometry::Box3 box_when_turned = empty_box();  // the same in the world's axes turned by the yaw [m]

  /// Of box_when_turned, in the world.
  [[nodiscard]] Eigen::Vector3d center_when_turned() const;
};

/// Box that blocks light and people.
struct Occluder {
  Eigen::Isometry3f world_from_box = Eigen::Isometry3f::Identity();
  Eigen::Vector3f half = Eigen::Vector3f::Zero();
  std::uint16_t object = 0;
};

/// A luminous rectangle: a ceiling lamp or a window.
struct Lamp {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();
  Eigen::Vector3f extent_a = Eigen::Vector3f::Zero();  // half axes of the rectangle
  Eigen::Vector3f extent_b = Eigen::Vector3f::Zero();
  Eigen::Array3f power = Eigen::Array3f::Ones();  // B, G, R
};

/// A room or a piece of a corridor with all that stands in it.
struct Room {
  geometry::Box3 box;  // between the inner faces of its walls, in the world [m]
  std::vector<Lamp> lamps;
  Mesh mesh;
  std::vector<Occluder> occluders;

  /// From a point to the box; 0 inside [m].
  [[nodiscard]] double distance(const Eigen::Vector3d& point) const {
    return (point - point.cwiseMax(box.min).cwiseMin(box.max)).norm();
  }
};

/// A way through a wall between two rooms: all that they see of each other, and where people go through.
struct Opening {
  std::array<std::size_t, 2> rooms{};  // indices
  geometry::Box3 box;                  // as deep as the wall is thick, in the world [m]
};

/// A building at rest. World: z up, floor at z = 0, metres.
struct Scene {
  Appearance appearance;
  std::vector<Room> rooms;
  std::vector<Opening> openings;
  std::vector<SceneObject> objects;  // index = Triangle::object; 0 is the building itself

  /// Smallest box around all rooms.
  [[nodiscard]] geometry::Box3 bounds() const;
  /// The first of the rooms that are nearest to `point`.
  [[nodiscard]] std::size_t room_at(const Eigen::Vector3d& point) const;
};

/// Puts shapes into the room that was begun last, in the frame of the object that was begun last.
class SceneBuilder {
 public:
  explicit SceneBuilder(Scene& scene) : scene_(scene) { scene_.objects.emplace_back(); }

  /// @return index of the new material that shows `picture`.
  std::uint16_t material(const cv::Mat& picture, const Material& look = {});

  /// The following shapes stand in a new room, and belong to the building itself, in world coordinates.
  void begin_room(const geometry::Box3& box, std::vector<Lamp> lamps);
  /// The following shapes belong to a new object with this label, standing at (x, y, z) and turned by
  /// `yaw_rad`.
  void begin(const std::string& label, float x, float y, float z, float yaw_rad);
  /// The following shapes belong to the building itself, in world coordinates.
  void begin_building();

  void box(const Eigen::Vector3f& center, const Eigen::Vector3f& size, std::uint16_t material,
           const TextureMapping& mapping = {});
  void box(const Eigen::Isometry3f& object_from_box, const Eigen::Vector3f& size, std::uint16_t material,
           const TextureMapping& mapping = {});
  /// Rectangle around `center`, facing right × up, showing its whole texture.
  void panel(const Eigen::Vector3f& center, const Eigen::Vector3f& right, const Eigen::Vector3f& up,
             std::uint16_t material, const TextureMapping& mapping = TextureMapping::fit());
  /// Turned body standing at `base`: (radius, height) pairs.
  void lathe(const Eigen::Vector3f& base, std::vector<Eigen::Vector2f> profile, std::uint16_t material,
             int segments = 20, float repeat_u = 1);
  void ellipsoid(const Eigen::Vector3f& center, const Eigen::Vector3f& half, std::uint16_t material);
  void loft(std::vector<Ring> rings, int segments, std::uint16_t material);

 private:
  void finish_shape(std::size_t first_vertex);
  [[nodiscard]] Room& room() { return scene_.rooms.back(); }
  [[nodiscard]] Surface surface(std::uint16_t material) const { return {material, object_}; }

  Scene& scene_;
  std::uint16_t object_ = 0;
  Eigen::Isometry3f world_from_object_ = Eigen::Isometry3f::Identity();
};

}  // namespace rds::simulator
