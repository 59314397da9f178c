// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "services/mapper/core/objects/object_extent.hpp"
#include "services/mapper/core/pipeline.hpp"

namespace rds::mapper {

/// The map as it stands.
struct SemanticMap {
  SemanticMap(const MapperConfig& config, std::uint64_t map_epoch, std::pmr::memory_resource* memory)
      : epoch(map_epoch), content(std::make_unique<Map>(config, memory)) {}

  std::uint64_t epoch;
  std::uint64_t revision = 0;  // 0: the empty map, which is never published
  LabelTable labels;
  std::unique_ptr<Map> content;

  [[nodiscard]] const octomap::ColorOcTree& tree() const { return content->octree.tree(); }
  [[nodiscard]] std::uint16_t label(const octomap::OcTreeKey& key) const {
    return content->octree.label(key);
  }
  /// Objects seen often and surely enough, with the extent of their voxels; those that have gone, too.
  /// @param up  unit vector against gravity, about which their boxes are turned.
  [[nodiscard]] std::vector<MapObject> objects(const Eigen::Vector3d& up = Eigen::Vector3d::UnitZ()) const {
    auto objects = content->objects.objects();
    find_gone(objects, content->evidence, content->octree, labels);
    fit_to_voxels(objects, content->octree, labels, up);
    return objects;
  }
};

}  // namespace rds::mapper
