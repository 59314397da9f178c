// SPDX-License-Identifier: Apache-2.0
// Our figures against those of the independent tools that judge the project (Python, RDS_SHARED/tools).
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/process.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/tools/evaluation/made_up_run.hpp"
#include "tools/evaluation/run_score.hpp"
#include "tools/evaluation/trajectory_evaluation.hpp"

namespace rds::evaluation {
namespace {
using nlohmann::json;

constexpr double kToleranceM = 1e-6;
constexpr double kToleranceOfShares = 5e-5;  // the judge prints four decimals

json judge(const std::string& tool, std::vector<std::string> arguments) {
  std::vector<std::string> command{"/usr/bin/python3", (test::shared() / "tools" / tool).string(), "--json"};
  command.insert(command.end(), arguments.begin(), arguments.end());
  const auto result = test::run_process(command, std::chrono::seconds(60));
  EXPECT_EQ(result.status, 0) << result.standard_error;
  return json::parse(result.standard_output, nullptr, false);
}

void expect_same(const ErrorStatistics& ours, const json& theirs, double tolerance) {
  EXPECT_NEAR(ours.rmse, theirs.at("rmse"), tolerance);
  EXPECT_NEAR(ours.mean, theirs.at("mean"), tolerance);
  EXPECT_NEAR(ours.median, theirs.at("median"), tolerance);
  EXPECT_NEAR(ours.max, theirs.at("max"), tolerance);
}

/// The truth at every third pose, in another frame, with a slow wave as its error.
std::vector<geometry::StampedPose> disturbed(const std::vector<geometry::StampedPose>& truth) {
  const auto elsewhere = geometry::make_pose({1, 2, 3}, Eigen::Quaterniond(0.3, 0.4, -0.5, 0.6));
  std::vector<geometry::StampedPose> estimate;
  for (std::size_t i = 1; i < truth.size(); i += 3) {
    const double wave = 0.05 * std::sin(0.02 * static_cast<double>(i));
    auto pose = truth[i];
    pose.stamp_text.clear();
    pose.stamp_ns += static_cast<std::int64_t>(i % 7) * 1'000'000;
    pose.map_from_camera = elsewhere * pose.map_from_camera;
    pose.map_from_camera.translate(Eigen::Vector3d(wave, -wave, 0.3 * wave));
    pose.map_from_camera.rotate(Eigen::AngleAxisd(wave, Eigen::Vector3d::UnitX()));
    estimate.push_back(pose);
  }
  return estimate;
}

class JudgeTrajectory : public testing::TestWithParam<const char*> {};

TEST_P(JudgeTrajectory, AgreesToAMicrometre) {
  RDS_REQUIRE_SHARED("tools/ate.py");
  const auto file = test::shared() / "data" / GetParam() / "groundtruth.txt";
  RDS_REQUIRE_SHARED("data/" + std::string(GetParam()));
  const test::TemporaryFolder folder;
  const auto truth = geometry::read_trajectory(file).value();
  ASSERT_TRUE(geometry::write_trajectory(folder / "estimate.txt", disturbed(truth)));
  const auto estimate = geometry::read_trajectory(folder / "estimate.txt").value();
  const auto ours = evaluate_trajectory(truth, estimate);
  const json theirs = judge("ate.py", {file.string(), (folder / "estimate.txt").string()});
  ASSERT_TRUE(ours && theirs.contains("ate"));
  EXPECT_EQ(ours->pairs.size(), theirs.at("pairs"));
  EXPECT_EQ(ours->relative->count, theirs.at("rpe").at("n"));
  expect_same(ours->absolute_m, theirs.at("ate"), kToleranceM);
  expect_same(ours->relative->translation_m, theirs.at("rpe").at("trans"), kToleranceM);
  expect_same(ours->relative->rotation_deg, theirs.at("rpe").at("rot_deg"), 1e-5);
  EXPECT_NEAR(ours->similarity_scale, theirs.at("scale"), 1e-6);
  EXPECT_NEAR(ours->path_m, theirs.at("path_m"), kToleranceM);
  EXPECT_NEAR(ours->span_s, theirs.at("span_s"), kToleranceM);
}

INSTANTIATE_TEST_SUITE_P(Recordings, JudgeTrajectory, testing::Values("tum_fr1_rpy", "7scenes_kitchen"),
                         [](const auto& test_case) { return "of_" + std::string(test_case.param); });

TEST(JudgeRun, AgreesWithinItsRounding) {
  RDS_REQUIRE_SHARED("tools/score.py");
  const test::TemporaryFolder folder;
  test::make_scored_run(folder.path());
  const auto ours = score_run({folder / "dataset", folder / "run", folder / "background", 5});
  ASSERT_TRUE(ours) << ours.error();
  const json theirs = judge("score.py", {(folder / "dataset").string(), (folder / "run").string(),
                                         "--background", (folder / "background").string()});
  ASSERT_TRUE(theirs.is_object());
  EXPECT_EQ(ours->size(), theirs.size());
  for (const auto& [name, value] : theirs.items()) {
    ASSERT_TRUE(ours->contains(name)) << name;
    EXPECT_NEAR(ours->at(name).get<double>(), value.get<double>(), kToleranceOfShares) << name;
  }
}

}  // namespace
}  // namespace rds::evaluation
