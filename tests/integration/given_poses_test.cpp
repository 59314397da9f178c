// SPDX-License-Identifier: Apache-2.0
// rds run --poses: what comes out has the poses that went in.
#include <gtest/gtest.h>

#include "common/geometry/trajectory.hpp"
#include "tests/integration/run_support.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/small_dataset.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::test {
namespace {

using geometry::StampedPose;

std::vector<StampedPose> poses_in(const std::filesystem::path& file) {
  auto poses = geometry::read_trajectory(file);
  EXPECT_TRUE(poses) << poses.error();
  return poses.value_or(std::vector<StampedPose>{});
}

/// Every pose of the run's three trajectories is one of `given`, to the digits that are printed.
void expect_poses(const std::filesystem::path& out, const std::vector<StampedPose>& given,
                  std::size_t frames) {
  EXPECT_EQ(poses_in(out / "trajectory.txt").size(), frames);
  EXPECT_EQ(poses_in(out / "trajectory_optimized.txt").size(), frames);
  EXPECT_GE(poses_in(out / "keyframes.txt").size(), 1U);
  for (const char* file : {"trajectory.txt", "trajectory_optimized.txt", "keyframes.txt"})
    for (const StampedPose& pose : poses_in(out / file)) {
      const auto truth = geometry::pose_at(given, pose.stamp_ns, 0);
      ASSERT_TRUE(truth.has_value()) << file << " " << pose.stamp_text;
      EXPECT_TRUE(pose.map_from_camera.isApprox(*truth, 5e-9)) << file << " " << pose.stamp_text;
    }
}

TEST(GivenPoses, AreFollowedEvenWhereNothingCanBeTracked) {
  const TemporaryFolder place;
  make_small_dataset(place / "data", 8);
  std::vector<StampedPose> given = poses_in(place / "data/groundtruth.txt");
  ASSERT_EQ(given.size(), 8U);
  for (StampedPose& pose : given) pose.map_from_camera.pretranslate(Eigen::Vector3d(7, 8, 9));
  given.erase(given.begin() + 3);  // the gap of 67 ms is too wide for the setting below
  ASSERT_TRUE(geometry::write_trajectory(place / "poses.txt", given));
  write_text(place / "config.yaml", "tracker: {poses_max_gap_s: 0.05}\n");
  const ProcessResult result =
      run(place / "data", place / "out",
          {"--rate", "max", "--no-dynamics", "--poses", (place / "poses.txt").string(), "--config",
           (place / "config.yaml").string()});
  ASSERT_EQ(result.status, 0) << result.standard_error;
  expect_poses(place / "out", given, 7);
  EXPECT_TRUE(exists(place / "out/map.ot"));
}

TEST(GivenPoses, MakeTheMapOfARecording) {
  const TemporaryFolder place;
  const auto dataset = recording_of_a_room().folder;
  const ProcessResult result = run(dataset, place / "out",
                                   {"--rate", "max", "--no-dynamics", "--start", "200", "--frames", "60",
                                    "--poses", (dataset / "groundtruth.txt").string()});
  ASSERT_EQ(result.status, 0) << result.standard_error;
  expect_poses(place / "out", poses_in(dataset / "groundtruth.txt"), 60);
  const auto summary = nlohmann::json::parse(read_text(place / "out/summary.json"));
  EXPECT_GE(summary["frames"]["keyframes"].get<int>(), 3);
  EXPECT_EQ(summary["poses"], (dataset / "groundtruth.txt").string());
  EXPECT_LT(summary["ate_final"].get<double>(), 1e-6);
  const ProcessResult info = run_process({rds(), "map", "info", "--map", (place / "out/map.ot").string()},
                                         std::chrono::seconds(30), {});
  EXPECT_EQ(info.status, 0) << info.standard_error;
}

}  // namespace
}  // namespace rds::test
