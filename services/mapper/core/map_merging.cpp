// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/map_merging.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace rds::mapper {
namespace {

constexpr std::size_t kMinVoxels = 8;  // of an object; fewer say nothing, as in find_gone()

/// Each label's index in a table that has them all.
std::vector<std::uint16_t> indices_in(LabelTable& all, const LabelTable& labels) {
  std::vector<std::uint16_t> indices;
  for (const std::string& name : labels.names()) indices.push_back(all.index_of(name));
  return indices;
}

/// Calls visit(key) for each voxel in a box.
template <class Visit>
void for_each_voxel_in(const geometry::Box3& box, double voxel_m, Visit visit) {
  const octomap::OcTreeKey from = key_around(box.min, voxel_m);
  const octomap::OcTreeKey to = key_around(box.max, voxel_m);
  for (unsigned x = from[0]; x <= to[0]; ++x)
    for (unsigned y = from[1]; y <= to[1]; ++y)
      for (unsigned z = from[2]; z <= to[2]; ++z)
        visit(octomap::OcTreeKey(static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y),
                                 static_cast<std::uint16_t>(z)));
}

/// Whether most of the voxels in an object's box that had its label are free by now.
bool is_seen_to_be_gone(const MapObject& object, const SavedMap& earlier, const FinalMap& now,
                        double voxel_m) {
  const auto& names = earlier.labels.names();
  const auto label = std::ranges::find(names, object.label) - names.begin();
  std::size_t voxels = 0;
  std::size_t free = 0;
  const geometry::Box3 box{object.center - object.size / 2, object.center + object.size / 2};
  for_each_voxel_in(box, voxel_m, [&](const octomap::OcTreeKey& key) {
    const VoxelLook* look = earlier.voxels->look(key);
    if (look == nullptr || look->label() != label) return;
    const LogOdds* value = now.value(key);
    ++voxels;
    free += value != nullptr && *value <= 0 ? 1U : 0U;
  });
  return voxels >= kMinVoxels && 3 * free > 2 * voxels;
}

}  // namespace

MergedMap merge_maps(const SavedMap& earlier, const SavedMap& later,
                     std::span<const geometry::PoseChange> moved, const MapperConfig& config) {
  MergedMap merged{earlier, {}, 0, 0};
  SavedMap& saved = merged.saved;
  const MapMotion motion(moved);
  const auto label_of = indices_in(saved.labels, later.labels);
  const double voxel_m = config.octree.resolution_m;
  saved.voxels = std::make_shared<const FinalMap>(
      add_later(*earlier.voxels, {*later.voxels, motion, label_of}, voxel_m, merged.voxels));
  merged.gone_objects = saved.objects->let_go_unless(
      [&](const MapObject& object) { return !is_seen_to_be_gone(object, earlier, *saved.voxels, voxel_m); });
  merged.common_objects = saved.objects->add_later(
      *later.objects, [&](const Eigen::Vector3d& point) { return motion.after_from_before(point); });
  return merged;
}

}  // namespace rds::mapper
