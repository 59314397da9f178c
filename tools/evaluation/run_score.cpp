// SPDX-License-Identifier: Apache-2.0
#include "tools/evaluation/run_score.hpp"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "common/geometry/trajectory.hpp"
#include "common/image/camera_yaml.hpp"
#include "common/image/tum_list.hpp"
#include "tools/evaluation/box_score.hpp"
#include "tools/evaluation/frame_times.hpp"
#include "tools/evaluation/loops/loop_score.hpp"
#include "tools/evaluation/loops/returns.hpp"
#include "tools/evaluation/map_score.hpp"
#include "tools/evaluation/objects/object_score.hpp"
#include "tools/evaluation/placed_map.hpp"
#include "tools/evaluation/statistics.hpp"
#include "tools/evaluation/trajectory_evaluation.hpp"
#include "tools/evaluation/visits/visit_score.hpp"

namespace rds::evaluation {
namespace {
using Figures = nlohmann::ordered_json;
using Result = tl::expected<void, std::string>;

Result add_trajectories(const RunScoreInput& input, Figures& figures) {
  const auto frames = image::read_tum_list(input.dataset / "rgb.txt");
  if (!frames) return tl::unexpected(frames.error());
  const auto truth = geometry::read_trajectory(input.dataset / "groundtruth.txt");
  if (!truth) return tl::unexpected(truth.error());
  const auto count = static_cast<double>(frames->entries.size() + frames->repeated);
  for (const auto& [name, file] :
       {std::pair("live", "trajectory.txt"), std::pair("final", "trajectory_optimized.txt")}) {
    const auto path = input.out / file;
    if (!std::filesystem::exists(path)) continue;
    const auto estimate = geometry::read_trajectory(path);
    if (!estimate) return tl::unexpected(estimate.error());
    if (name == std::string("live")) figures["tracked"] = static_cast<double>(estimate->size()) / count;
    const auto errors = evaluate_trajectory(*truth, *estimate);
    if (!errors)
      return tl::unexpected(
          fmt::format("{}: expected at least 3 poses that match groundtruth.txt in time", path.string()));
    figures[fmt::format("ate_{}", name)] = errors->absolute_m.rmse;
  }
  return {};
}

Result add_loops(const RunScoreInput& input, Figures& figures) {
  const auto file = input.out / "loops.jsonl";
  if (!std::filesystem::exists(file)) return {};
  const auto truth = geometry::read_trajectory(input.dataset / "groundtruth.txt");
  if (!truth) return tl::unexpected(truth.error());
  const auto score = score_loops(file, *truth);
  if (!score) return tl::unexpected(score.error());
  figures["loops_true"] = score->right;
  figures["loops_false"] = score->wrong;
  const auto keyframes = geometry::read_trajectory(input.out / "keyframes.txt");
  if (keyframes) figures["loops_missed"] = score_returns(*keyframes, *truth).missed_share();
  return {};
}

Result add_times(const RunScoreInput& input, Figures& figures) {
  const auto file = input.out / "frames.csv";
  if (!std::filesystem::exists(file)) return {};
  const auto columns = read_csv_columns(file, {"total_ms", "predict_ms"});
  if (!columns) return tl::unexpected(columns.error());
  for (const std::string stage : {"total", "predict"}) {
    const auto found = columns->find(stage + "_ms");
    if (found == columns->end()) continue;
    figures["ms_" + stage + "_median"] = percentile(found->second, 50);
    figures["ms_" + stage + "_p99"] = percentile(found->second, 99);
  }
  return {};
}

Result add_boxes(const RunScoreInput& input, Figures& figures) {
  if (!std::filesystem::exists(input.out / "predictions.jsonl")) return {};
  if (!std::filesystem::exists(input.dataset / "people.json")) return {};
  const auto people = read_people(input.dataset / "people.json");
  if (!people) return tl::unexpected(people.error());
  const auto predictions = read_predictions(input.out / "predictions.jsonl");
  if (!predictions) return tl::unexpected(predictions.error());
  cv::Size picture(640, 480);  // of the TUM cameras, whose recordings need no camera.yaml
  if (const auto file = input.dataset / "camera.yaml"; std::filesystem::exists(file)) {
    const auto description = image::read_camera_yaml(file);
    if (!description) return tl::unexpected(description.error());
    picture = {description->camera.width, description->camera.height};
  }
  const BoxScore score = score_boxes(*people, *predictions, picture);
  figures["box_people"] = score.people;
  figures["box_recall"] = score.recall;
  figures["box_iou"] = score.mean_iou;
  figures["box_cover"] = score.cover;
  figures["box_waste"] = score.waste;
  return {};
}

Result add_map(const RunScoreInput& input, Figures& figures) {
  if (!input.background || !std::filesystem::exists(input.out / "map.ot")) return {};
  const auto score = score_map({input.dataset, *input.background, input.out, input.every, {}, input.align});
  if (!score) return tl::unexpected(score.error());
  figures["map_nodes"] = score->nodes;
  figures["map_occupied"] = score->occupied;
  figures["resolution"] = score->resolution_m;
  figures["static_recall"] = score->static_recall;
  figures["map_precision"] = score->precision;
  if (!score->residue) return {};
  figures["people_voxels"] = score->residue->people_voxels;
  figures["residue"] = score->residue->residue;
  figures["residue_map"] = score->residue->residue_map;
  return {};
}

Result add_objects(const RunScoreInput& input, Figures& figures) {
  for (const auto& file : {input.dataset / "objects.json", input.dataset / "detections_truth.jsonl",
                           input.out / "objects.json", input.out / "map.ot", input.out / "keyframes.txt"})
    if (!std::filesystem::exists(file)) return {};
  const auto map = read_placed_map(input.dataset, input.out, input.align);
  if (!map) return tl::unexpected(map.error());
  const auto score =
      score_objects({input.dataset,
                     input.out,
                     map->truth_from_map,
                     {map->tree.occupied_centers(), map->tree.occupied_colors(), map->tree.resolution_m}});
  if (!score) return tl::unexpected(score.error());
  figures["objects_wanted"] = score->wanted;
  figures["objects_found"] = score->found;
  figures["objects_wrong"] = score->wrong;
  for (const auto& [name, share] : {std::pair{"object_f1", score->f1},
                                    {"object_iou", score->iou},
                                    {"object_labelled", score->labelled},
                                    {"object_label_true", score->label_true}})
    if (std::isfinite(share)) figures[name] = share;
  return {};
}

Result add_visit(const RunScoreInput& input, Figures& figures) {
  if (input.earlier.empty()) return {};
  const auto map = read_placed_map(input.dataset, input.out, input.align);
  if (!map) return tl::unexpected(map.error());
  VisitScoreInput visits{{}, {}, map->tree.occupied_centers(), map->tree.resolution_m, input.every};
  for (Eigen::Vector3d& center : visits.map) center = map->truth_from_map * center;
  const auto read = [&](const std::filesystem::path& recording) {
    return read_surfaces(recording, visits.voxel_m).map([&](std::vector<Eigen::Vector3d>&& surfaces) {
      return Visit{recording, std::move(surfaces)};
    });
  };
  auto today = read(input.dataset);
  if (!today) return tl::unexpected(today.error());
  visits.visit = std::move(*today);
  for (const auto& recording : input.earlier) {
    auto before = read(recording);
    if (!before) return tl::unexpected(before.error());
    visits.earlier.push_back(std::move(*before));
  }
  const auto score = score_visit(visits);
  if (!score) return tl::unexpected(score.error());
  figures["visit_recall"] = score->recall;
  figures["visit_precision"] = score->precision;
  figures["moved_from"] = score->moved_from;
  figures["moved_from_free"] = score->moved_from_free;
  figures["moved_to"] = score->moved_to;
  figures["moved_to_mapped"] = score->moved_to_mapped;
  return {};
}

}  // namespace

tl::expected<Figures, std::string> score_run(const RunScoreInput& input) {
  if (!std::filesystem::is_directory(input.out))
    return tl::unexpected(
        fmt::format("{}: no such folder, expected what `rds run --out` wrote", input.out.string()));
  Figures figures = Figures::object();
  for (const auto add : {add_trajectories, add_loops, add_times, add_boxes, add_map, add_objects, add_visit})
    if (const auto added = add(input, figures); !added) return tl::unexpected(added.error());
  if (figures.empty())
    return tl::unexpected(
        fmt::format("{}: nothing to score, expected trajectory.txt, frames.csv, predictions.jsonl or map.ot",
                    input.out.string()));
  return figures;
}

std::string to_text(const Figures& figures) {
  std::string text;
  for (const auto& [name, value] : figures.items())
    text += value.is_number_float() ? fmt::format("{:<18} {:.4f}\n", name, value.get<double>())
                                    : fmt::format("{:<18} {}\n", name, value.dump());
  return text;
}

}  // namespace rds::evaluation
