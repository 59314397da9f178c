// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/pipeline.hpp"

#include "services/mapper/core/objects/object_labels.hpp"
#include "services/mapper/core/segmentation/classify.hpp"
#include "services/mapper/core/segmentation/dynamic_masks.hpp"

namespace rds::mapper {

void interpret(KeyframeRecord& record, std::optional<std::span<const LabelledBox>> boxes,
               const MapperConfig& config, LabelTable& labels) {
  // Segment: what is movable, by boxes, depth and colour.
  classify_by_depth(record, config.sampling);
  const geometry::DepthNoise& noise = config.sampling.depth_noise;
  const DynamicMasks masks = boxes ? segment_dynamic(record, *boxes, noise) : DynamicMasks{};

  // Classify: every pixel is static, doubtful, unknown, dynamic or no evidence.
  classify(record, masks, config);

  // Static objects get their pixels.
  if (boxes) label_static_objects(record, *boxes, config, labels);
}

}  // namespace rds::mapper
