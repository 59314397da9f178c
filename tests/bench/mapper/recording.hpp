// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <istream>
#include <map>
#include <vector>

#include "common/image/tum_dataset.hpp"
#include "services/mapper/core/keyframe/keyframe_input.hpp"

namespace rds::bench {

/// A recorded sequence with ground truth as keyframes for the mapper.
class Recording {
 public:
  /// @param boxes_file  people.json of the sequence, or a file of its form; detections.jsonl, or a file of
  /// its form, which tells of all objects; "" if nobody looked for objects. Static objects in the folder's
  /// objects.json ([{label, center, size}], map frame) count as seen in every frame.
  /// @throws std::runtime_error naming what is missing.
  Recording(const std::filesystem::path& folder, const std::filesystem::path& boxes_file);

  [[nodiscard]] std::size_t size() const { return dataset_.frames().size(); }
  /// Frame i: its pictures, the true pose between the recorded ones, the true boxes of people.
  [[nodiscard]] mapper::KeyframeInput keyframe(std::size_t i) const;

 private:
  void read_boxes(const std::filesystem::path& file);
  void read_detections(std::istream& in);
  void read_static_objects(const std::filesystem::path& file);

  image::TumDataset dataset_;
  bool has_boxes_ = false;
  std::map<std::int64_t, std::vector<mapper::LabelledBox>> boxes_;  // by stamp [µs]
  std::vector<mapper::LabelledBox> static_objects_;
};

}  // namespace rds::bench
