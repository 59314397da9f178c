// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <tl/expected.hpp>

#include "common/geometry/pose.hpp"

namespace rds::evaluation {

/// Occupied voxels of a map.
struct MapVoxels {
  std::vector<Eigen::Vector3d> centers;  // [m]
  std::vector<std::array<std::uint8_t, 3>> colors;
  double width_m = 0;
};

struct ObjectScoreInput {
  std::filesystem::path dataset;  // objects.json, detections_truth.jsonl, groundtruth.txt, camera.yaml
  std::filesystem::path out;      // objects.json, detections.jsonl
  geometry::Pose truth_from_map;
  MapVoxels voxels;  // in the map
};

/// The object database of a run against the truth of `rds simulate`. Shares are NaN where nothing is asked.
struct ObjectScore {
  std::size_t wanted =
      0;  // true objects that showed in enough frames, of a label that the detector named at all
  std::size_t found = 0;  // of them: an object of their label has its centre within 0.15 m, each once
  std::size_t wrong = 0;  // objects that are none of the true ones, of labels that the simulator names
  double f1 = 0;
  double iou = 0;       // of the upright boxes of true objects and those that found them, mean
  double labelled = 0;  // of the occupied voxels in the true boxes of what was found, what it stands on left
                        // out: have a label that is true there, or one voxel beside
  double label_true = 0;  // of the voxels that bear a found object's label, in its box: lie in a true box of
                          // that label, or one voxel beside
};

/// What was found of an object that hardly showed is neither right nor wrong. Labels of voxels are known by
/// their colours.
/// @return or one sentence that names what cannot be read.
tl::expected<ObjectScore, std::string> score_objects(ObjectScoreInput input);

}  // namespace rds::evaluation
