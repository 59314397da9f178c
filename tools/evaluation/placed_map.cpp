// SPDX-License-Identifier: Apache-2.0
#include "tools/evaluation/placed_map.hpp"

#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace rds::evaluation {
namespace {
constexpr double kSameSizeM = 1e-9;
}  // namespace

tl::expected<PlacedMap, std::string> read_placed_map(const std::filesystem::path& recording,
                                                     const std::filesystem::path& out, Alignment align) {
  const auto truth = geometry::read_trajectory(recording / "groundtruth.txt");
  if (!truth) return tl::unexpected(truth.error());
  const auto keyframes = geometry::read_trajectory(out / "keyframes.txt");
  if (!keyframes) return tl::unexpected(keyframes.error());
  const auto errors = evaluate_trajectory(*truth, *keyframes, {.align = align});
  if (!errors)
    return tl::unexpected(fmt::format("{}: expected at least 3 poses that match groundtruth.txt in time",
                                      (out / "keyframes.txt").string()));
  auto tree = read_octree_file(out / "map.ot");
  if (!tree) return tl::unexpected(tree.error());
  return PlacedMap{std::move(*tree), errors->truth_from_estimate};
}

tl::expected<std::vector<Eigen::Vector3d>, std::string> read_surfaces(const std::filesystem::path& recording,
                                                                      double voxel_m) {
  const auto file = recording / "truth.ot";
  const auto tree = read_octree_file(file);
  if (!tree) return tl::unexpected(tree.error());
  if (std::abs(tree->resolution_m - voxel_m) > kSameSizeM)
    return tl::unexpected(fmt::format("{}: voxels of {} m, expected {} m, as those of the map", file.string(),
                                      tree->resolution_m, voxel_m));
  return tree->occupied_centers();
}

}  // namespace rds::evaluation
