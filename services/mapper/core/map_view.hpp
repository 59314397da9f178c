// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "services/mapper/core/objects/object_extent.hpp"
#include "services/mapper/core/pipeline.hpp"

namespace rds::mapper {

/// The map as it stands, for those who only read it.
class MapView {
 public:
  [[nodiscard]] const octomap::ColorOcTree& tree() const { return map_->octree.tree(); }
  [[nodiscard]] std::uint16_t label(const octomap::OcTreeKey& key) const { return map_->octree.label(key); }
  [[nodiscard]] const LabelTable& labels() const { return labels_; }
  /// Objects seen often and surely enough, with the extent of their voxels.
  [[nodiscard]] std::vector<MapObject> objects() const {
    auto objects = map_->objects.objects();
    fit_to_voxels(objects, map_->octree, labels_);
    return objects;
  }
  [[nodiscard]] std::uint64_t map_epoch() const { return map_epoch_; }
  [[nodiscard]] std::uint64_t revision() const { return revision_; }
  [[nodiscard]] const MapperConfig& config() const { return config_; }

 protected:
  MapView(MapperConfig config, std::uint64_t map_epoch)
      : config_(std::move(config)), map_epoch_(map_epoch), map_(std::make_unique<Map>(config_)) {}

  MapperConfig config_;
  std::uint64_t map_epoch_;
  std::uint64_t revision_ = 0;  // 0: the empty map, which is never published
  LabelTable labels_;
  std::unique_ptr<Map> map_;
};

}  // namespace rds::mapper
