// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/pipeline.hpp"

#include "services/mapper/core/evidence/classify.hpp"
#include "services/mapper/core/objects/object_labels.hpp"
#include "services/mapper/core/segmentation/dynamic_masks.hpp"

namespace rds::mapper {

void interpret(KeyframeRecord& record, std::optional<std::span<const LabelledBox>> boxes,
               const MapperConfig& config, LabelTable& labels) {
  // Segment: movable objects are cut out of their boxes by depth.
  classify_by_depth(record, config.sampling);
  const DynamicMasks masks = boxes ? segment_dynamic(record, *boxes, config) : DynamicMasks{};

  // Classify: every pixel is static, dynamic, unknown or no evidence; some static ones are to be confirmed.
  classify(record, masks, config);

  // Static objects get their pixels.
  if (boxes) label_static_objects(record, *boxes, config, labels);
}

void add_evidence(const KeyframeRecord& record, const MapperConfig& config, const LabelTable& labels,
                  Map& map) {
  map.history.see(record, config);
  map.objects.integrate(record, labels);
}

void update_map(const KeyframeRecord& record, const SceneHistory& history, const MapperConfig& config,
                const LabelTable& labels, Scan& scan, Map& map, MapDelta& delta) {
  // Classify, second part: other keyframes confirm static pixels, or do not.
  const PixelClasses classes = resolve(record, history, config);

  // Ray-cast: each voxel is a hit, a miss or nothing.
  cast_rays(record, classes, config.octree, config.sampling, scan);

  // Update: log-odds, colours and labels.
  map.octree.integrate({scan, record.objects.looked_for, map.objects.undetected(record, labels), labels,
                        history, record.time_ns, delta});
}

void add_saved_surfaces(Map& map) {
  const auto& tree = map.octree.tree();
  for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf)
    if (tree.isNodeOccupied(*leaf)) map.history.statics.know(leaf.getKey());
}

}  // namespace rds::mapper
