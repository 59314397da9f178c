// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <set>
#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "common/geometry/box.hpp"
#include "common/geometry/trajectory.hpp"
#include "tools/evaluation/objects/object_file.hpp"

namespace rds::evaluation {

struct ImageBox {
  std::string label;
  geometry::Box2 box;
  double depth_m = 0;
};
struct DetectedFrame {
  std::int64_t stamp_ns = 0;
  std::vector<ImageBox> boxes;
};

/// Reads detections.jsonl, or a recording's detections_truth.jsonl.
/// @return or one sentence that names file, line and what was expected.
tl::expected<std::vector<DetectedFrame>, std::string> read_detected_frames(const std::filesystem::path& file);

/// Whether each of some things showed: in five of every eighth frame there is a box of its label, nearer than
/// 4 m, that is most of what the thing would be in a picture without end (IoU of at least one half).
std::vector<bool> which_showed(std::span<const LabelledThing> things, std::span<const DetectedFrame> frames,
                               std::span<const geometry::StampedPose> world_from_camera,
                               const geometry::CameraModel& camera);

}  // namespace rds::evaluation
