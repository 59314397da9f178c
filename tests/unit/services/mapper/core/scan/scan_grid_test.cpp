// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/scan/scan_grid.hpp"

#include <array>
#include <random>
#include <set>

#include <gtest/gtest.h>
#include <octomap/OcTree.h>

namespace rds::mapper {
namespace {

using Key = std::array<int, 3>;

std::set<Key> marked(const ScanGrid& grid, ScanFlag flag = kFreeSpace) {
  std::set<Key> keys;
  for (const auto& block : grid.blocks())
    for (int x = 0; x < 8; ++x)
      for (int y = 0; y < 8; ++y)
        for (int z = 0; z < 8; ++z) {
          const octomap::OcTreeKey key(static_cast<std::uint16_t>(block.key[0] + x),
                                       static_cast<std::uint16_t>(block.key[1] + y),
                                       static_cast<std::uint16_t>(block.key[2] + z));
          if ((block.flags[cell_of(key)] & flag) != 0) keys.insert({key[0], key[1], key[2]});
        }
  return keys;
}

TEST(ScanGrid, RaysPassWhereOctoMapsRaysPass) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.5, 1.5);
  octomap::OcTree tree(0.05);
  ScanGrid grid;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d a(uniform(random), uniform(random), uniform(random));
    const Eigen::Vector3d b(uniform(random), uniform(random), uniform(random));
    grid.reset({32730, 32730, 32730}, {32806, 32806, 32806});
    const auto in_voxels = [](const Eigen::Vector3d& p) {
      return Eigen::Vector3d(p / 0.05 + Eigen::Vector3d::Constant(32768));
    };
    grid.cast_rays(in_voxels(a), std::array{in_voxels(b)});
    const auto ours = marked(grid);
    octomap::KeyRay theirs;
    tree.computeRayKeys(
        octomap::point3d(static_cast<float>(a.x()), static_cast<float>(a.y()), static_cast<float>(a.z())),
        octomap::point3d(static_cast<float>(b.x()), static_cast<float>(b.y()), static_cast<float>(b.z())),
        theirs);
    std::size_t missing = 0;
    for (const auto& key : theirs) missing += ours.contains({key[0], key[1], key[2]}) ? 0U : 1U;
    EXPECT_LE(missing, theirs.size() / 20 + 1) << "ray " << i;  // float rounding at voxel edges
    EXPECT_NEAR(static_cast<double>(ours.size()), static_cast<double>(theirs.size()), 3);
  }
}

TEST(ScanGrid, RaysTogetherMarkWhatEachMarksAlone) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(101, 139);
  const auto point = [&] { return Eigen::Vector3d(uniform(random), uniform(random), uniform(random)); };
  const Eigen::Vector3d from = point();
  std::vector<Eigen::Vector3d> ends;
  std::set<Key> alone;
  ScanGrid grid;
  for (int i = 0; i < 7; ++i) {  // the last one has no other beside it
    ends.push_back(point());
    grid.reset({100, 100, 100}, {140, 140, 140});
    grid.cast_rays(from, std::array{ends.back()});
    alone.merge(marked(grid));
    grid.reset({100, 100, 100}, {140, 140, 140});
    grid.cast_rays(from, ends);
    EXPECT_EQ(marked(grid), alone) << ends.size() << " rays";
  }
}

TEST(ScanGrid, ARayEndsBeforeItsLastVoxelAndCoversAxesExactly) {
  ScanGrid grid;
  grid.reset({100, 100, 100}, {140, 140, 140});
  grid.cast_rays({101.5, 102.5, 103.5}, std::array{Eigen::Vector3d(110.5, 102.5, 103.5)});
  std::set<Key> expected;
  for (int x = 101; x < 110; ++x) expected.insert({x, 102, 103});
  EXPECT_EQ(marked(grid), expected);
  grid.reset({100, 100, 100}, {140, 140, 140});
  grid.cast_rays({120.2, 120.2, 120.2}, std::array{Eigen::Vector3d(120.8, 120.9, 120.1)});
  EXPECT_TRUE(marked(grid).empty());
}

TEST(ScanGrid, NeighboursAreMarkedInTouchedBlocksOnly) {
  ScanGrid grid;
  grid.reset({96, 96, 96}, {127, 127, 127});
  const octomap::OcTreeKey corner(103, 103, 103);
  grid.block_of(corner);
  grid.block_of({104, 103, 103});
  grid.mark_beside(corner);
  std::set<Key> expected;
  for (int z = 102; z <= 103; ++z)
    for (int y = 102; y <= 103; ++y)
      for (int x = 102; x <= 104; ++x) expected.insert({x, y, z});
  EXPECT_EQ(marked(grid, kBesideSurface), expected);
}

TEST(ScanGrid, NeighboursEndWithTheGrid) {
  ScanGrid grid;
  grid.reset({96, 96, 96}, {127, 127, 127});
  for (const auto first : std::array<std::uint16_t, 2>{96, 120})
    for (const auto second : std::array<std::uint16_t, 2>{96, 120}) grid.block_of({first, second, 96});
  grid.mark_beside({96, 96, 96});
  EXPECT_EQ(marked(grid, kBesideSurface).size(), 8);
}

}  // namespace
}  // namespace rds::mapper
