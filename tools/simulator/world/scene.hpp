// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "common/geometry/box.hpp"
#include "tools/simulator/rendering/mesh.hpp"

namespace rds::simulator {

/// A thing of the room. Things without a label (books, lamps, walls) are not part of the truth.
struct SceneObject {
  std::string label;  // as in VOC: chair, tvmonitor, diningtable, sofa, pottedplant, bottle; or empty
  geometry::Box3 box{Eigen::Vector3d::Constant(1e9), Eigen::Vector3d::Constant(-1e9)};  // in the world [m]
};

/// Box that blocks light and people.
struct Occluder {
  Eigen::Isometry3f world_from_box = Eigen::Isometry3f::Identity();
  Eigen::Vector3f half = Eigen::Vector3f::Zero();
  std::uint16_t object = 0;
};

/// The room at rest. World: z up, floor at z = 0, origin in the middle of the floor, metres.
struct Scene {
  Eigen::Vector3d size = Eigen::Vector3d::Zero();  // of the room
  Appearance appearance;
  Mesh mesh;
  std::vector<SceneObject> objects;  // index = Triangle::object; 0 is the room itself
  std::vector<Occluder> occluders;
};

/// Puts shapes into a scene, in the frame of the object that was begun last.
class SceneBuilder {
 public:
  explicit SceneBuilder(Scene& scene) : scene_(scene) { scene_.objects.emplace_back(); }

  /// @return index of the new material that shows `picture`.
  std::uint16_t material(const cv::Mat& picture, const Material& look = {});

  /// The following shapes belong to a new object with this label, standing at (x, y, z) and turned by
  /// `yaw_rad`.
  void begin(const std::string& label, float x, float y, float z, float yaw_rad);
  /// The following shapes belong to the room itself, in world coordinates.
  void begin_room();

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
  [[nodiscard]] Surface surface(std::uint16_t material) const { return {material, object_}; }

  Scene& scene_;
  std::uint16_t object_ = 0;
  Eigen::Isometry3f world_from_object_ = Eigen::Isometry3f::Identity();
};

}  // namespace rds::simulator
