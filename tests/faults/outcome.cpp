// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/outcome.hpp"

#include <algorithm>
#include <stdexcept>

#include "tests/integration/run_support.hpp"
#include "tools/evaluation/octree_file.hpp"
#include "tools/evaluation/voxels/voxel_set.hpp"

namespace rds::test {
namespace {

evaluation::VoxelSet occupied_voxels(const std::filesystem::path& results) {
  const auto tree = evaluation::read_octree_file(results / "map.ot");
  if (!tree) throw std::runtime_error(tree.error());
  std::vector<evaluation::VoxelKey> keys;
  for (const auto& center : tree->occupied_centers())
    keys.push_back(evaluation::voxel_of(center, tree->resolution_m));
  return evaluation::make_voxel_set(std::move(keys));
}

/// Of the undisturbed map's voxels the share with a voxel in the 3×3×3 around. Both maps have the first
/// camera's frame.
double recall_of_map(const std::filesystem::path& out, const std::filesystem::path& undisturbed) {
  const auto map = occupied_voxels(out);
  const auto expected = occupied_voxels(undisturbed);
  const auto found = std::ranges::count_if(
      expected, [&](evaluation::VoxelKey key) { return evaluation::has_neighbour(map, key, 1); });
  return static_cast<double>(found) / static_cast<double>(expected.size());
}

}  // namespace

Figures figures_of(const std::filesystem::path& recording, const std::filesystem::path& out,
                   const std::filesystem::path& undisturbed) {
  const auto path = score(recording, out);
  return {path["ate_live"].get<double>(), path["ate_final"].get<double>(), recall_of_map(out, undisturbed)};
}

}  // namespace rds::test
