// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/pipeline.hpp"

#include "services/mapper/core/objects/object_labels.hpp"
#include "services/mapper/core/segmentation/classify.hpp"
#include "services/mapper/core/segmentation/dynamic_masks.hpp"
#include "services/mapper/core/segmentation/keyframe_cells.hpp"

namespace rds::mapper {

void interpret(KeyframeRecord& record, std::optional<std::span<const LabelledBox>> boxes,
               const MapperConfig& config, LabelTable& labels) {
  // Segment: what is movable, by boxes, depth and colour.
  classify_by_depth(record, config.sampling);
  const cv::Mat1w colours = boxes && !boxes->empty() ? colours_in_cells(record) : cv::Mat1w();
  const auto by_boxes = boxes ? segment_dynamic(record, colours, *boxes) : std::vector<ByBoxes>();

  // Classify: every pixel is static, doubtful, unknown, dynamic or no evidence.
  classify(record, by_boxes, config);

  // Static objects get their pixels.
  if (boxes) label_static_objects(record, colours, *boxes, config, labels);
}

}  // namespace rds::mapper
