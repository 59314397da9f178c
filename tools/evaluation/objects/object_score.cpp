// SPDX-License-Identifier: Apache-2.0
#include "tools/evaluation/objects/object_score.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <tuple>
#include <vector>

#include "common/geometry/trajectory.hpp"
#include "common/image/camera_yaml.hpp"
#include "common/labels/table.hpp"
#include "tools/evaluation/objects/shown_things.hpp"
#include "tools/evaluation/objects/upright_iou.hpp"

namespace rds::evaluation {
namespace {

using geometry::OrientedBox;
using geometry::Pose;
using Things = std::vector<LabelledThing>;
using Matches = std::map<std::size_t, std::size_t>;  // of true things to found ones

constexpr double kNearM = 0.15;  // between centres
// What `rds simulate` names. Books stand in its shelves, too, but of them the truth says nothing.
constexpr std::array kNamed{"bottle", "chair", "diningtable", "pottedplant", "sofa", "tvmonitor"};

/// Nearest first; each true thing and each found one once.
Matches match(const Things& truth, const Things& found) {
  std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < truth.size(); ++i)
    for (std::size_t j = 0; j < found.size(); ++j) {
      const double distance = (truth[i].box.center() - found[j].box.center()).norm();
      if (truth[i].label == found[j].label && distance <= kNearM) pairs.emplace_back(distance, i, j);
    }
  std::ranges::sort(pairs);
  Matches matches;
  std::set<std::size_t> taken;
  for (const auto& [distance, i, j] : pairs)
    if (!matches.contains(i) && taken.insert(j).second) matches.emplace(i, j);
  return matches;
}

/// Whether a found thing that is none of the true ones is of one that hardly showed.
bool is_of(const LabelledThing& found, const LabelledThing& truth) {
  return found.label == truth.label &&
         (found.box.center() - truth.box.center()).norm() < truth.box.size.norm() / 2;
}

/// @param above  by how much its lower face is raised [m].
bool is_inside(const Eigen::Vector3d& point, const OrientedBox& box, double margin_m, double above_m = 0) {
  const Eigen::Vector3d p = box.map_from_box.inverse() * point;
  const Eigen::Array3d half = box.size.array() / 2 + margin_m;
  return (p.array().abs() <= half).all() && p.z() >= -half.z() + above_m;
}

bool bears(const MapVoxels& voxels, std::size_t i, const std::string& label) {
  static const labels::Table kTable;
  return kTable[label].color == voxels.colors[i];
}

/// Whether a voxel bears the label of a thing that is there.
bool is_label_right(const MapVoxels& voxels, std::size_t i, const Things& truth) {
  return std::ranges::any_of(truth, [&](const LabelledThing& thing) {
    return bears(voxels, i, thing.label) && is_inside(voxels.centers[i], thing.box, voxels.width_m);
  });
}

double share(std::size_t part, std::size_t whole) {
  return static_cast<double>(part) / static_cast<double>(whole);
}

/// @param voxels  in the truth's frame. @param unknown  things of labels that the detector does not name:
/// what is in their boxes may be theirs.
void score_labels(const MapVoxels& voxels, const Things& truth, const Things& unknown, const Things& found,
                  const Matches& matches, ObjectScore& score) {
  std::size_t asked = 0;
  std::size_t labelled = 0;
  std::size_t borne = 0;
  std::size_t right = 0;
  for (std::size_t v = 0; v < voxels.centers.size(); ++v) {
    const Eigen::Vector3d& at = voxels.centers[v];
    const bool of_unknown = std::ranges::any_of(
        unknown, [&](const LabelledThing& thing) { return is_inside(at, thing.box, voxels.width_m); });
    const bool is_asked = !of_unknown && std::ranges::any_of(matches, [&](const auto& pair) {
      return is_inside(at, truth[pair.first].box, 0, voxels.width_m);
    });
    const bool is_borne = std::ranges::any_of(matches, [&](const auto& pair) {
      const LabelledThing& thing = found[pair.second];
      return bears(voxels, v, thing.label) && is_inside(at, thing.box, 0);
    });
    if (!is_asked && !is_borne) continue;
    const bool is_right = is_label_right(voxels, v, truth);
    asked += is_asked ? 1U : 0U;
    labelled += is_asked && is_right ? 1U : 0U;
    borne += is_borne ? 1U : 0U;
    right += is_borne && is_right ? 1U : 0U;
  }
  score.labelled = share(labelled, asked);
  score.label_true = share(right, borne);
}

ObjectScore score_of(const Things& truth, const std::vector<bool>& showed, const Things& found,
                     const Matches& matches) {
  ObjectScore score;
  std::set<std::size_t> matched;
  double iou = 0;
  for (const auto& [i, j] : matches) {
    matched.insert(j);
    if (!showed[i]) continue;
    ++score.found;
    iou += upright_iou(truth[i].box, found[j].box);
  }
  score.wanted = static_cast<std::size_t>(std::ranges::count(showed, true));
  for (std::size_t j = 0; j < found.size(); ++j) {
    const auto hides = [&](std::size_t i) { return !showed[i] && is_of(found[j], truth[i]); };
    bool is_excused = matched.contains(j);
    for (std::size_t i = 0; i < truth.size() && !is_excused; ++i) is_excused = hides(i);
    if (!is_excused) ++score.wrong;
  }
  score.f1 = share(2 * score.found, score.wanted + score.found + score.wrong);
  score.iou = iou / static_cast<double>(score.found);
  return score;
}

/// Takes away and returns the things of labels that a run's detector never named.
tl::expected<Things, std::string> take_unknown(Things& truth, const std::filesystem::path& detections) {
  if (!std::filesystem::exists(detections)) return Things{};
  const auto frames = read_detected_frames(detections);
  if (!frames) return tl::unexpected(frames.error());
  std::set<std::string> known;
  for (const DetectedFrame& frame : *frames)
    for (const ImageBox& seen : frame.boxes) known.insert(seen.label);
  Things unknown;
  std::ranges::copy_if(truth, std::back_inserter(unknown),
                       [&](const LabelledThing& thing) { return !known.contains(thing.label); });
  std::erase_if(truth, [&](const LabelledThing& thing) { return !known.contains(thing.label); });
  return unknown;
}

}  // namespace

tl::expected<ObjectScore, std::string> score_objects(ObjectScoreInput input) {
  auto truth = read_things(input.dataset / "objects.json");
  if (!truth) return tl::unexpected(truth.error());
  auto found = read_things(input.out / "objects.json");
  if (!found) return tl::unexpected(found.error());
  const auto poses = geometry::read_trajectory(input.dataset / "groundtruth.txt");
  if (!poses) return tl::unexpected(poses.error());
  const auto description = image::read_camera_yaml(input.dataset / "camera.yaml");
  if (!description) return tl::unexpected(description.error());
  const auto frames = read_detected_frames(input.dataset / "detections_truth.jsonl");
  if (!frames) return tl::unexpected(frames.error());
  const auto unknown = take_unknown(*truth, input.out / "detections.jsonl");
  if (!unknown) return tl::unexpected(unknown.error());

  std::erase_if(*found, [](const LabelledThing& thing) {
    return std::ranges::find(kNamed, thing.label) == kNamed.end();
  });
  for (LabelledThing& thing : *found) thing.box.map_from_box = input.truth_from_map * thing.box.map_from_box;
  for (Eigen::Vector3d& center : input.voxels.centers) center = input.truth_from_map * center;
  const Matches matches = match(*truth, *found);
  ObjectScore score =
      score_of(*truth, which_showed(*truth, *frames, *poses, description->camera), *found, matches);
  score_labels(input.voxels, *truth, *unknown, *found, matches, score);
  return score;
}

}  // namespace rds::evaluation
