// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/objects/object_extent.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "services/mapper/core/objects/trimmed_box.hpp"
#include "services/mapper/core/octree/occupancy_grid.hpp"

namespace rds::mapper {
namespace {

constexpr double kReachM = 0.15;       // around the box of the sightings
constexpr std::size_t kMinVoxels = 8;  // fewer say nothing
constexpr double kGoodPart = 0.25;     // of the evidence on an object's label, as of the votes on a voxel's

geometry::Box3 box_of(const MapObject& object) {
  return {object.center - object.size / 2, object.center + object.size / 2};
}

/// How far a point is from an object's box, and from its middle where boxes overlap [m].
std::pair<double, double> distance_m(const Eigen::Vector3d& point, const MapObject& object) {
  const auto box = box_of(object);
  return {(box.min - point).cwiseMax(point - box.max).cwiseMax(0.0).norm(), (point - object.center).norm()};
}

std::uint16_t index_of(const MapObject& object, const LabelTable& labels) {
  return static_cast<std::uint16_t>(std::ranges::find(labels.names(), object.label) - labels.names().begin());
}

/// Calls visit(leaf) for each known voxel in and around an object's box.
template <class Visit>
void for_each_voxel_of(const MapObject& object, const octomap::ColorOcTree& tree, Visit visit) {
  const auto corner = [](const Eigen::Vector3d& p) {
    const Eigen::Vector3f f = p.cast<float>();
    return octomap::point3d(f.x(), f.y(), f.z());
  };
  const Eigen::Vector3d reach = object.size / 2 + Eigen::Vector3d::Constant(kReachM);
  const auto end = tree.end_leafs_bbx();
  for (auto leaf = tree.begin_leafs_bbx(corner(object.center - reach), corner(object.center + reach));
       leaf != end; ++leaf)
    visit(leaf);
}

bool bears(const MapObject& object, const std::string& label) {
  return std::ranges::any_of(object.labels, [&](const LabelBelief& belief) {
    return belief.label == label && belief.share >= kGoodPart;
  });
}

/// Centres of the occupied voxels that bear a label of the object and are nearer to it than to others of it.
std::vector<Eigen::Vector3d> voxels_of(const MapObject& object, const std::vector<MapObject>& all,
                                       const SemanticOctree& octree, const LabelTable& labels) {
  std::vector<Eigen::Vector3d> voxels;
  for_each_voxel_of(object, octree.tree(), [&](const auto& leaf) {
    if (!octree.tree().isNodeOccupied(*leaf)) return;
    const std::uint16_t index = octree.label(leaf.getKey());
    if (index == 0 || !bears(object, labels.names()[index])) return;
    const Eigen::Vector3d voxel(leaf.getX(), leaf.getY(), leaf.getZ());
    const bool of_another = std::ranges::any_of(all, [&](const MapObject& other) {
      return !other.has_gone && bears(other, labels.names()[index]) &&
             distance_m(voxel, other) < distance_m(voxel, object);
    });
    if (!of_another) voxels.push_back(voxel);
  });
  return voxels;
}

std::vector<Eigen::Vector3d> corners_of(const MapObject& object) {
  std::vector<Eigen::Vector3d> corners;
  for (int i = 0; i < 8; ++i)
    corners.emplace_back(object.center + object.size.cwiseProduct(Eigen::Vector3d(i & 1, i >> 1 & 1, i >> 2) -
                                                                  Eigen::Vector3d::Constant(0.5)));
  return corners;
}

}  // namespace

void fit_to_voxels(std::span<MapObject> objects, const SemanticOctree& octree, const LabelTable& labels,
                   const Eigen::Vector3d& up) {
  const std::vector<MapObject> all(objects.begin(), objects.end());
  const Eigen::Matrix3d map_from_level = level_frame(up);
  const double voxel_m = octree.tree().getResolution();
  for (auto& object : objects) {
    object.upright = upright_box(corners_of(object), map_from_level, voxel_m);
    if (object.has_gone) continue;
    const auto voxels = voxels_of(object, all, octree, labels);
    if (voxels.size() < kMinVoxels) continue;
    const geometry::Box3 centers = trimmed_box(voxels);
    object.center = centers.center();
    object.size = centers.size() + Eigen::Vector3d::Constant(voxel_m);
    object.upright = upright_box(voxels, map_from_level, voxel_m);
  }
}

void find_gone(std::span<MapObject> objects, const Evidence& evidence, const SemanticOctree& octree,
               const LabelTable& labels) {
  for (auto& object : objects) {
    if (object.has_gone || object.seen_through == 0) continue;
    const std::uint16_t label = index_of(object, labels);
    std::size_t voxels = 0;
    std::size_t free = 0;
    for_each_voxel_of(object, octree.tree(), [&](const auto& leaf) {
      const octomap::OcTreeKey key = leaf.getKey();
      const EvidenceBlock* block = evidence.block(key);
      const VoxelLook* look = block != nullptr ? block->look(cell_of(key)) : nullptr;
      if (look == nullptr || look->label() != label) return;
      ++voxels;
      free += octree.tree().isNodeOccupied(*leaf) ? 0U : 1U;
    });
    object.has_gone = voxels >= kMinVoxels && 3 * free > 2 * voxels;
  }
}

}  // namespace rds::mapper
