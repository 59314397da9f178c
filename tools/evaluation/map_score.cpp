// SPDX-License-Identifier: Apache-2.0
#include "tools/evaluation/map_score.hpp"

#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "common/geometry/stamp.hpp"
#include "tools/evaluation/octree_file.hpp"
#include "tools/evaluation/surface_sampler.hpp"
#include "tools/evaluation/trajectory_evaluation.hpp"

namespace rds::evaluation {
namespace {
using geometry::StampedPose;

constexpr double kLargestMeanErrorM = 1.0;
constexpr std::size_t kFewestSightings = 3;
constexpr std::int64_t kMaskToleranceNs = 20'000'000;
constexpr int kMaskErosionPx = 9;

/// Surfaces of the recording without people.
struct StaticSurfaces {
  VoxelSet all;
  VoxelSet solid;  // seen in at least three of the pictures, and in a keyframe
};

tl::expected<StaticSurfaces, std::string> static_surfaces(const MapScoreInput& input,
                                                          const std::vector<StampedPose>& truth,
                                                          const std::vector<StampedPose>& keyframes,
                                                          double resolution_m) {
  const auto sampler = SurfaceSampler::open(input.background);
  if (!sampler) return tl::unexpected(sampler.error());
  std::set<std::size_t> of_keyframes;
  for (const auto& keyframe : keyframes) of_keyframes.insert(sampler->nearest(keyframe.stamp_ns));
  std::set<std::size_t> pictures = of_keyframes;
  const auto step = static_cast<std::size_t>(input.every);
  for (std::size_t n = 0; n < sampler->depth_pictures().size(); n += step) pictures.insert(n);

  std::vector<VoxelSet> sightings;
  std::vector<VoxelKey> seen;
  for (const std::size_t n : pictures) {
    const auto pose = geometry::interpolate(truth, sampler->depth_pictures()[n].stamp_ns);
    auto voxels = sampler->voxels(n, pose, resolution_m);
    if (!voxels) return tl::unexpected(voxels.error());
    if (of_keyframes.contains(n)) seen.insert(seen.end(), voxels->begin(), voxels->end());
    sightings.push_back(std::move(*voxels));
  }
  const VoxelSet seen_in_keyframes = make_voxel_set(std::move(seen));
  StaticSurfaces surfaces;
  for (const auto& [key, count] : count_voxels(sightings)) {
    surfaces.all.push_back(key);
    if (count >= kFewestSightings && std::ranges::binary_search(seen_in_keyframes, key))
      surfaces.solid.push_back(key);
  }
  return surfaces;
}

struct MaskFile {
  std::int64_t stamp_ns;
  std::filesystem::path file;
};

/// masks/<stamp>.png, ascending.
std::vector<MaskFile> list_masks(const std::filesystem::path& folder) {
  std::vector<MaskFile> masks;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (const auto stamp = geometry::parse_stamp_ns(entry.path().stem().string()))
      masks.push_back({*stamp, entry.path()});
  std::ranges::sort(masks, {}, &MaskFile::stamp_ns);
  return masks;
}

/// Where people are, eroded so that pixels at their edges do not count.
tl::expected<cv::Mat, std::string> read_mask(const std::filesystem::path& file, cv::Size expected_size) {
  const cv::Mat raw = cv::imread(file.string(), cv::IMREAD_GRAYSCALE);
  if (raw.size() != expected_size)
    return tl::unexpected(fmt::format("{}: expected a mask of {}×{} px", file.string(), expected_size.width,
                                      expected_size.height));
  cv::Mat mask;
  cv::erode(raw > 0, mask, cv::Mat::ones(kMaskErosionPx, kMaskErosionPx, CV_8UC1));
  return mask;
}

/// Voxels that people's surfaces passed through.
tl::expected<VoxelSet, std::string> people_voxels(const MapScoreInput& input,
                                                  const std::vector<StampedPose>& truth,
                                                  double resolution_m) {
  const auto sampler = SurfaceSampler::open(input.dataset);
  if (!sampler) return tl::unexpected(sampler.error());
  const auto masks = list_masks(input.dataset / "masks");
  std::vector<VoxelKey> keys;
  const auto step = static_cast<std::size_t>(input.every);
  for (std::size_t n = 0; n < sampler->depth_pictures().size() && !masks.empty(); n += step) {
    const std::int64_t stamp = sampler->depth_pictures()[n].stamp_ns;
    const auto off = [&](const MaskFile& mask) { return std::abs(mask.stamp_ns - stamp); };
    const auto nearest = std::ranges::min_element(masks, {}, off);
    if (off(*nearest) > kMaskToleranceNs) continue;
    const auto mask = read_mask(nearest->file, sampler->picture_size());
    if (!mask) return tl::unexpected(mask.error());
    const auto voxels = sampler->voxels(n, geometry::interpolate(truth, stamp), resolution_m, *mask);
    if (!voxels) return tl::unexpected(voxels.error());
    keys.insert(keys.end(), voxels->begin(), voxels->end());
  }
  return make_voxel_set(std::move(keys));
}

double share(std::size_t part, std::size_t whole) {
  return static_cast<double>(part) / static_cast<double>(whole);
}

std::size_t count_near(const std::vector<VoxelKey>& keys, const VoxelSet& set, int radius) {
  return static_cast<std::size_t>(
      std::ranges::count_if(keys, [&](VoxelKey key) { return has_neighbour(set, key, radius); }));
}

ResidueScore residue_of(const VoxelSet& people, const VoxelSet& surfaces,
                        const std::vector<VoxelKey>& map_voxels) {
  const VoxelSet map = make_voxel_set(map_voxels);
  ResidueScore score;
  std::size_t left = 0;
  for (const VoxelKey key : people) {
    if (has_neighbour(surfaces, key, 1)) continue;
    ++score.people_voxels;
    if (std::ranges::binary_search(map, key)) ++left;
  }
  score.residue = share(left, score.people_voxels);
  score.residue_map = share(left, std::max<std::size_t>(1, map_voxels.size()));
  return score;
}

/// The map's occupied voxels in the truth's frame and grid; two of them may fall into one.
tl::expected<std::vector<VoxelKey>, std::string> map_in_truth(const OctreeFile& tree,
                                                              const MapScoreInput& input,
                                                              const std::vector<StampedPose>& truth,
                                                              const std::vector<StampedPose>& keyframes) {
  const auto errors = evaluate_trajectory(truth, keyframes, {.align = input.align});
  const auto file = (input.out / "keyframes.txt").string();
  if (!errors)
    return tl::unexpected(
        fmt::format("{}: expected at least 3 poses that match groundtruth.txt in time", file));
  if (errors->absolute_m.mean > kLargestMeanErrorM)
    return tl::unexpected(fmt::format("{}: {:.2f} m off groundtruth.txt on average, expected less than 1 m",
                                      file, errors->absolute_m.mean));
  std::vector<VoxelKey> keys;
  for (const auto& center : tree.occupied_centers())
    keys.push_back(voxel_of(errors->truth_from_estimate * center, tree.resolution_m));
  return keys;
}

}  // namespace

tl::expected<MapScore, std::string> score_map(const MapScoreInput& input) {
  const auto tree = read_octree_file(input.out / "map.ot");
  if (!tree) return tl::unexpected(tree.error());
  const auto truth = geometry::read_trajectory(input.dataset / "groundtruth.txt");
  if (!truth) return tl::unexpected(truth.error());
  const auto keyframes = geometry::read_trajectory(input.out / "keyframes.txt");
  if (!keyframes) return tl::unexpected(keyframes.error());
  const auto map = map_in_truth(*tree, input, *truth, *keyframes);
  if (!map) return tl::unexpected(map.error());
  const auto seen =
      input.seen_by.empty() ? keyframes : geometry::read_trajectory(input.seen_by / "keyframes.txt");
  if (!seen) return tl::unexpected(seen.error());
  const auto surfaces = static_surfaces(input, *truth, *seen, tree->resolution_m);
  if (!surfaces) return tl::unexpected(surfaces.error());

  MapScore score{tree->nodes, map->size(), tree->resolution_m, 0, 0, std::nullopt};
  score.static_recall = share(count_near(surfaces->solid, make_voxel_set(*map), 1), surfaces->solid.size());
  score.precision = share(count_near(*map, surfaces->all, 2), map->size());
  if (std::filesystem::is_directory(input.dataset / "masks")) {
    const auto people = people_voxels(input, *truth, tree->resolution_m);
    if (!people) return tl::unexpected(people.error());
    score.residue = residue_of(*people, surfaces->all, *map);
  }
  return score;
}

}  // namespace rds::evaluation
