// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <tl/expected.hpp>

#include "tools/evaluation/trajectory_evaluation.hpp"

namespace rds::evaluation {

struct RunScoreInput {
  std::filesystem::path dataset;  // with groundtruth.txt; people.json and masks/ where people walk
  std::filesystem::path out;      // what `rds run --out` wrote; a file that is missing leaves its figures out
  std::optional<std::filesystem::path>
      background;                           // the sequence without people: switches the map's figures on
  int every = 5;                            // depth pictures between two that the map is compared with
  Alignment align = Alignment::kPositions;  // of map and objects
  std::vector<std::filesystem::path> earlier = {};  // recordings of the floor on days before: what has moved
};

/// The figures of a whole run against exact truth, by name: tracked, ate_live, ate_final [m],
/// loops_true, loops_false (pairs of keyframes), loops_missed (share of keyframes, ReturnScore),
/// ms_total_median, ms_total_p99, ms_predict_median, ms_predict_p99 [ms], box_people, box_recall, box_iou,
/// box_cover, box_waste, map_nodes, map_occupied, resolution [m], static_recall, map_precision,
/// people_voxels, residue, residue_map, objects_wanted, objects_found, objects_wrong, object_f1, object_iou,
/// object_labelled, object_label_true (ObjectScore), visit_recall, visit_precision, moved_from,
/// moved_from_free, moved_to, moved_to_mapped (VisitScore).
///
/// @return or one sentence that names the file, the line and what was expected.
tl::expected<nlohmann::ordered_json, std::string> score_run(const RunScoreInput& input);

/// One figure per line, `name value`, four decimals.
std::string to_text(const nlohmann::ordered_json& figures);

}  // namespace rds::evaluation
