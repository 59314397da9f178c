// SPDX-License-Identifier: Apache-2.0
#include "tools/evaluation/loops/loop_score.hpp"

#include <gmock/gmock.h>

#include "tests/support/temporary_folder.hpp"

namespace rds::evaluation {
namespace {

/// A camera that goes 1 m/s along x, ten poses a second.
std::vector<geometry::StampedPose> truth() {
  std::vector<geometry::StampedPose> poses;
  for (std::int64_t i = 0; i <= 50; ++i)
    poses.push_back(
        {i * 100'000'000,
         geometry::make_pose({0.1 * static_cast<double>(i), 0, 0}, Eigen::Quaterniond::Identity()),
         {}});
  return poses;
}

TEST(LoopScore, TellsRightFromWrong) {
  const test::TemporaryFolder folder;
  test::write_text(
      folder / "loops.jsonl",
      R"({"stamp": 4.0, "loops": [{"earlier": 1.0, "earlier_from_later": [3.1, 0, 0, 0, 0, 0, 1]},
 {"earlier": 2.0, "earlier_from_later": [2.2, 0, 0, 0, 0, 0, 1]}]})"
      "\n");
  EXPECT_THAT(score_loops(folder / "loops.jsonl", truth()).error(),
              ::testing::HasSubstr("loops.jsonl:1: expected"));
  test::write_text(
      folder / "loops.jsonl",
      R"({"stamp": 4.0, "loops": [{"earlier": 1.0, "earlier_from_later": [3.1, 0, 0, 0, 0, 0, 1]}]})"
      "\n"
      R"({"stamp": 4.5, "loops": [{"earlier": 2.5, "earlier_from_later": [2.2, 0, 0, 0, 0, 0, 1]}, )"
      R"({"earlier": 2.5, "earlier_from_later": [2, 0, 0, 0, 0.1, 0, 0.995]}, )"
      R"({"earlier": 99, "earlier_from_later": [2, 0, 0, 0, 0, 0, 1]}]})"
      "\n");
  const auto score = score_loops(folder / "loops.jsonl", truth());
  ASSERT_TRUE(score) << score.error();
  EXPECT_EQ(score->right, 1U);
  EXPECT_EQ(score->wrong, 2U);
}

}  // namespace
}  // namespace rds::evaluation
