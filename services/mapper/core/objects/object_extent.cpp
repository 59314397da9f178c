// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/objects/object_extent.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "services/mapper/core/objects/trimmed_box.hpp"

namespace rds::mapper {
namespace {

constexpr double kReachM = 0.15;       // around the box of the sightings
constexpr std::size_t kMinVoxels = 8;  // fewer say nothing

geometry::Box3 box_of(const MapObject& object) {
  return {object.center - object.size / 2, object.center + object.size / 2};
}

/// How far a point is from an object's box, and from its middle where boxes overlap [m].
std::pair<double, double> distance_m(const Eigen::Vector3d& point, const MapObject& object) {
  const auto box = box_of(object);
  return {(box.min - point).cwiseMax(point - box.max).cwiseMax(0.0).norm(), (point - object.center).norm()};
}

/// Centres of the occupied voxels that bear the object's label and are nearer to it than to others of this
/// label.
std::vector<Eigen::Vector3d> voxels_of(const MapObject& object, const std::vector<MapObject>& all,
                                       const SemanticOctree& octree, std::uint16_t label) {
  const auto corner = [](const Eigen::Vector3d& p) {
    const Eigen::Vector3f f = p.cast<float>();
    return octomap::point3d(f.x(), f.y(), f.z());
  };
  const Eigen::Vector3d reach = object.size / 2 + Eigen::Vector3d::Constant(kReachM);
  const auto& tree = octree.tree();
  std::vector<Eigen::Vector3d> voxels;
  const auto end = tree.end_leafs_bbx();
  for (auto leaf = tree.begin_leafs_bbx(corner(object.center - reach), corner(object.center + reach));
       leaf != end; ++leaf) {
    if (!tree.isNodeOccupied(*leaf) || octree.label(leaf.getKey()) != label) continue;
    const Eigen::Vector3d voxel(leaf.getX(), leaf.getY(), leaf.getZ());
    const bool of_another = std::ranges::any_of(all, [&](const MapObject& other) {
      return other.label == object.label && distance_m(voxel, other) < distance_m(voxel, object);
    });
    if (!of_another) voxels.push_back(voxel);
  }
  return voxels;
}

}  // namespace

void fit_to_voxels(std::span<MapObject> objects, const SemanticOctree& octree, const LabelTable& labels) {
  const std::vector<MapObject> all(objects.begin(), objects.end());
  for (auto& object : objects) {
    const auto index = std::ranges::find(labels.names(), object.label) - labels.names().begin();
    const auto voxels = voxels_of(object, all, octree, static_cast<std::uint16_t>(index));
    if (voxels.size() < kMinVoxels) continue;
    const geometry::Box3 centers = trimmed_box(voxels);
    object.center = centers.center();
    object.size = centers.size() + Eigen::Vector3d::Constant(octree.tree().getResolution());
  }
}

}  // namespace rds::mapper
