// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/truth_map.hpp"

#include <gtest/gtest.h>
#include <octomap/OcTree.h>

namespace rds::simulator {
namespace {

/// A table top of 1 × 0.6 m, 0.72 m above the floor.
Scene table_top() {
  Scene scene;
  scene.rooms.push_back({{{-2, -2, 0}, {2, 2, 2.6}}, {}, {}, {}});
  add_quad(scene.rooms.front().mesh, {0.01F, 0.61F, 0.72F}, {1, 0, 0}, {0, -0.6F, 0}, {}, {}, 0.3F);
  return scene;
}

TEST(TruthMap, SurfacePointsLieOnTheSurfaceAndReachItsCorners) {
  const auto points = surface_points(table_top().rooms.front().mesh);
  Eigen::AlignedBox3f box;
  for (const auto& p : points) box.extend(p);
  EXPECT_NEAR((box.min() - Eigen::Vector3f(0.01F, 0.01F, 0.72F)).norm(), 0, 1e-5);
  EXPECT_NEAR((box.max() - Eigen::Vector3f(1.01F, 0.61F, 0.72F)).norm(), 0, 1e-5);
}

TEST(TruthMap, EveryVoxelOfASurfaceIsOccupiedAndNoOther) {
  const auto file = std::filesystem::temp_directory_path() / "rds_truth_map_test.ot";
  write_truth_map(table_top(), file);
  const std::unique_ptr<octomap::AbstractOcTree> read(octomap::AbstractOcTree::read(file.string()));
  std::filesystem::remove(file);
  auto* tree = dynamic_cast<octomap::OcTree*>(read.get());
  ASSERT_NE(tree, nullptr);
  tree->expand();
  EXPECT_EQ(tree->getNumLeafNodes(), 21U * 13U);  // from 0.01 to 1.01 and from 0.01 to 0.61, in steps of 0.05
  for (float x = 0.025F; x < 1.04F; x += 0.05F)
    for (float y = 0.025F; y < 0.64F; y += 0.05F)
      EXPECT_NE(tree->search(x, y, 0.725F), nullptr) << x << ' ' << y;
}

TEST(TruthMap, NamesTheFileThatCannotBeWritten) {
  EXPECT_THROW(write_truth_map(table_top(), "/proc/no/such/truth.ot"), std::runtime_error);
}

}  // namespace
}  // namespace rds::simulator
