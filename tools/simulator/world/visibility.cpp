// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/world/visibility.hpp"

#include <algorithm>
#include <array>
#include <optional>

namespace rds::simulator {
namespace {

using geometry::Box2;

constexpr double kNear = 0.05;
constexpr double kInDoorway = 0.15;  // so near to a room the camera is in it: deeper than a wall [m]

/// Follows openings from room to room with the part of the picture that is seen through all of them.
class PortalWalk {
 public:
  PortalWalk(const Scene& scene, const geometry::CameraModel& camera, const geometry::Pose& world_from_camera)
      : scene_(scene),
        camera_(camera),
        camera_from_world_(world_from_camera.inverse()),
        visible_(scene.rooms.size(), false),
        passed_(scene.rooms.size(), false) {}

  void enter(std::size_t room, const Box2& window) {
    visible_[room] = true;
    passed_[room] = true;
    for (const Opening& opening : scene_.openings) {
      const auto side = std::ranges::find(opening.rooms, room);
      if (side == opening.rooms.end()) continue;
      const std::size_t other = opening.rooms[side == opening.rooms.begin() ? 1 : 0];
      if (passed_[other]) continue;
      if (const auto seen = seen_through(opening.box, window)) enter(other, *seen);
    }
    passed_[room] = false;
  }

  [[nodiscard]] std::vector<std::size_t> visible() const {
    std::vector<std::size_t> rooms;
    for (std::size_t i = 0; i < visible_.size(); ++i)
      if (visible_[i]) rooms.push_back(i);
    return rooms;
  }

 private:
  /// The part of `window` that an opening covers.
  [[nodiscard]] std::optional<Box2> seen_through(const geometry::Box3& opening, const Box2& window) const {
    std::array<Eigen::Vector3d, 8> corners;
    for (std::size_t i = 0; i < corners.size(); ++i)
      corners[i] = camera_from_world_ * Eigen::Vector3d((i & 1U) != 0 ? opening.max.x() : opening.min.x(),
                                                        (i & 2U) != 0 ? opening.max.y() : opening.min.y(),
                                                        (i & 4U) != 0 ? opening.max.z() : opening.min.z());
    Eigen::AlignedBox2d box;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Eigen::Vector3d& a = corners[i];
      if (a.z() >= kNear) box.extend(camera_.project_undistorted(a));
      for (const std::size_t bit : {1U, 2U, 4U}) {
        const Eigen::Vector3d& b = corners[i ^ bit];
        if (a.z() < kNear && b.z() > kNear)
          box.extend(camera_.project_undistorted(a + (b - a) * ((kNear - a.z()) / (b.z() - a.z()))));
      }
    }
    if (box.isEmpty()) return std::nullopt;
    const Box2 seen{std::max(box.min().x(), window.x0), std::max(box.min().y(), window.y0),
                    std::min(box.max().x(), window.x1), std::min(box.max().y(), window.y1)};
    if (seen.x0 >= seen.x1 || seen.y0 >= seen.y1) return std::nullopt;
    return seen;
  }

  const Scene& scene_;
  const geometry::CameraModel& camera_;
  geometry::Pose camera_from_world_;
  std::vector<bool> visible_;
  std::vector<bool> passed_;  // on the way to the present room
};

}  // namespace

std::vector<std::size_t> visible_rooms(const Scene& scene, const geometry::CameraModel& camera,
                                       const geometry::Pose& world_from_camera) {
  PortalWalk walk(scene, camera, world_from_camera);
  const Box2 picture{-0.5, -0.5, camera.width - 0.5, camera.height - 0.5};
  for (std::size_t i = 0; i < scene.rooms.size(); ++i)
    if (scene.rooms[i].distance(world_from_camera.translation()) < kInDoorway) walk.enter(i, picture);
  return walk.visible();
}

}  // namespace rds::simulator
