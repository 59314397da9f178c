// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/octree/occupancy_grid.hpp"

#include <gmock/gmock.h>

#include "services/mapper/core/segmentation/gravity.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/services/mapper/core/synthetic_keyframe.hpp"

namespace rds::mapper {
namespace {

/// A level room in a frame with z up: floor at −1 m, free space above it, a pillar at (1, 0).
octomap::ColorOcTree room(const Eigen::Matrix3d& map_from_level = Eigen::Matrix3d::Identity(),
                          bool with_gap = false) {
  octomap::ColorOcTree tree(0.05);
  const auto set = [&](double x, double y, double z, bool occupied) {
    const Eigen::Vector3d p = map_from_level * Eigen::Vector3d(x, y, z);
    tree.setNodeValue(p.x(), p.y(), p.z(), occupied ? 0.85F : -0.41F);
  };
  for (double x = -2.025; x < 2; x += 0.05)
    for (double y = -1.025; y < 1; y += 0.05) {
      if (with_gap && std::abs(x + 1.025) < 0.01 && std::abs(y - 0.525) < 0.01)
        continue;  // nobody looked here
      set(x, y, -1.025, true);
      for (double z = -0.975; z < 0; z += 0.05) set(x, y, z, std::abs(x - 1) < 0.12 && std::abs(y) < 0.12);
    }
  tree.expand();
  return tree;
}

std::int8_t at_level(const OccupancyGrid& grid, const Eigen::Vector3d& point_in_map) {
  const Eigen::Vector3d p = grid.map_from_grid.inverse() * point_in_map / grid.resolution;
  return grid.at(static_cast<int>(std::floor(p.x())), static_cast<int>(std::floor(p.y())));
}

TEST(OccupancyGrid, TellsFreeOccupiedAndUnknown) {
  const auto grid = make_grid(room(), Eigen::Vector3d::UnitZ(), GridConfig{});
  EXPECT_EQ(at_level(grid, {1, 0, 0}), OccupancyGrid::kOccupied);
  EXPECT_EQ(at_level(grid, {-1, 0.5, 0}), OccupancyGrid::kFree);
  EXPECT_NEAR(grid.width * grid.resolution, 4.05, 0.1);
  EXPECT_NEAR(grid.height * grid.resolution, 2.05, 0.1);
  EXPECT_NEAR(grid.map_from_grid.translation().z(), -1.0, 0.06);
  const auto gap = make_grid(room(Eigen::Matrix3d::Identity(), true), Eigen::Vector3d::UnitZ(), GridConfig{});
  EXPECT_EQ(at_level(gap, {-1.025, 0.525, 0}), OccupancyGrid::kUnknown);
}

TEST(OccupancyGrid, ATiltedMapGivesTheSameGridWithoutHoles) {
  const Eigen::Matrix3d tilted =
      Eigen::AngleAxisd(1.9, Eigen::Vector3d(1, 0.2, 0.1).normalized()).toRotationMatrix();
  const Eigen::Vector3d up = tilted.col(2);
  const auto grid = make_grid(room(tilted), up, GridConfig{});
  EXPECT_EQ(at_level(grid, tilted * Eigen::Vector3d(1, 0, 0)), OccupancyGrid::kOccupied);
  int unknown = 0;
  for (double x = -1.8; x < 0.8; x += 0.05)
    for (double y = -0.8; y < 0.8; y += 0.05)
      unknown += at_level(grid, tilted * Eigen::Vector3d(x, y, 0)) == OccupancyGrid::kUnknown ? 1 : 0;
  EXPECT_EQ(unknown, 0);
}

TEST(OccupancyGrid, APrunedMapGivesTheSameGrid) {
  octomap::ColorOcTree pruned = room();
  pruned.prune();
  ASSERT_LT(pruned.getNumLeafNodes(), room().getNumLeafNodes());
  const auto grid = make_grid(pruned, Eigen::Vector3d::UnitZ(), GridConfig{});
  EXPECT_EQ(grid.data, make_grid(room(), Eigen::Vector3d::UnitZ(), GridConfig{}).data);
}

TEST(OccupancyGrid, TooFewOccupiedVoxelsAreNoObstacleButNotFreeEither) {
  octomap::ColorOcTree tree(0.05);
  tree.setNodeValue(0.025, 0.025, 0.525, 0.85F);
  tree.setNodeValue(0.525, 0.025, 0.525, 0.85F);
  tree.setNodeValue(0.525, 0.025, 0.575, -0.41F);
  GridConfig config;
  config.floor = "0";
  config.min_occupied = 2;
  const auto grid = make_grid(tree, Eigen::Vector3d::UnitZ(), config);
  EXPECT_EQ(at_level(grid, {0.025, 0.025, 0}), OccupancyGrid::kUnknown);
  EXPECT_EQ(at_level(grid, {0.525, 0.025, 0}), OccupancyGrid::kFree);
  config.min_occupied = 1;
  const auto strict = make_grid(tree, Eigen::Vector3d::UnitZ(), config);
  EXPECT_EQ(at_level(strict, {0.025, 0.025, 0}), OccupancyGrid::kOccupied);
}

TEST(OccupancyGrid, TheFloorMustBeAHeight) {
  const rds::test::TemporaryFolder folder;
  for (const std::string floor : {"nan", "inf", "low", "\"\""}) {
    rds::test::write_text(folder / "mapper.yaml", "grid: {floor: " + floor + "}\n");
    auto reader = config::ConfigReader::from_file((folder / "mapper.yaml").string());
    MapperConfig config;
    read(reader, config);
    EXPECT_THROW(reader.finish(), config::ConfigError) << floor;
  }
}

TEST(OccupancyGrid, AnEmptyMapGivesAnEmptyGrid) {
  const auto grid = make_grid(octomap::ColorOcTree(0.05), Eigen::Vector3d::UnitZ(), GridConfig{});
  EXPECT_EQ(grid.width, 0);
  EXPECT_TRUE(grid.data.empty());
}

TEST(OccupancyGrid, WritesWhatMapServerReads) {
  OccupancyGrid grid;
  grid.width = 2;
  grid.height = 2;
  grid.resolution = 0.05;
  grid.data = {0, 100, -1, 0};
  const auto pgm = to_pgm(grid);
  const std::string pixels = pgm.substr(pgm.size() - 4);
  EXPECT_EQ(pixels, std::string("\xcd\xfe\xfe\x00", 4));
  EXPECT_THAT(pgm, testing::StartsWith("P5\n"));
  EXPECT_THAT(
      to_map_server_yaml(grid, "grid.pgm"),
      testing::AllOf(testing::HasSubstr("image: grid.pgm"), testing::HasSubstr("resolution: 0.050000"),
                     testing::HasSubstr("origin: [0.000000, 0.000000, 0.0]")));
}

TEST(Gravity, IsFoundFromTheFloorOfATiltedCamera) {
  // A camera 1.2 m above the floor, looking 35° down: rows below the horizon see the floor.
  constexpr double kTilt = 0.61;
  const geometry::Pose map_from_camera(Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitZ()));
  const Eigen::Vector3d up_in_camera(0, -std::cos(kTilt), -std::sin(kTilt));
  auto keyframe = test::SyntheticKeyframe(0).pose(map_from_camera).make();
  for (int y = 0; y < 240; ++y)
    for (int x = 0; x < 320; ++x) {
      const double slope = -keyframe.camera.ray({double{1} * x, double{1} * y}).dot(up_in_camera);
      keyframe.depth.values.at<float>(y, x) = slope > 0.3 ? static_cast<float>(1.2 / slope) : 0.0F;
    }
  MapperConfig config;
  config.grid.up = "surfaces";
  SemanticMapper mapper(config);
  mapper.integrate(keyframe);
  const Eigen::Vector3d expected = map_from_camera.linear() * up_in_camera;
  EXPECT_GT(mapper.up_in_map().dot(expected), std::cos(0.02));
}

TEST(Gravity, IsAlongZOfTheMapThatATrackerMakes) {
  EXPECT_EQ(SemanticMapper(MapperConfig{}).up_in_map(), Eigen::Vector3d::UnitZ());
}

TEST(Gravity, FallsBackToTheCamerasOwnUpAndToTheConfiguredAxis) {
  EXPECT_TRUE(estimate_up({}, {}).isApprox(-Eigen::Vector3d::UnitY()));
  EXPECT_TRUE(axis_of("-y").isApprox(-Eigen::Vector3d::UnitY()));
  EXPECT_TRUE(axis_of("z").isApprox(Eigen::Vector3d::UnitZ()));
  EXPECT_THROW(axis_of("up"), std::invalid_argument);
}

}  // namespace
}  // namespace rds::mapper
