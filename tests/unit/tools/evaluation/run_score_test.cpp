// SPDX-License-Identifier: Apache-2.0
#include "tools/evaluation/run_score.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"
#include "tests/unit/tools/evaluation/made_up_run.hpp"
#include "tools/evaluation/box_score.hpp"

namespace rds::evaluation {
namespace {
using geometry::Box2;
using testing::AllOf;
using testing::HasSubstr;

PeopleFrame frame_at(double time_s, const Box2& box) {
  return {time_s, {{box, 0.9, 5000}}};
}

TEST(ScoreBoxes, CountsHitsCoverAndWaste) {
  const std::vector<PeopleFrame> truth{frame_at(0, {0, 0, 100, 100}), frame_at(2, {0, 0, 100, 100}),
                                       frame_at(3, {200, 200, 300, 300})};
  const std::vector<PredictedFrame> predictions{{0, {{400, 0, 500, 100}}},
                                                {2.004, {{0, 0, 100, 80}, {500, 0, 600, 96}}},
                                                {3.006, {{200, 200, 300, 300}}}};
  const auto score = score_boxes(truth, predictions, {640, 480});
  EXPECT_EQ(score.people, 2U);
  EXPECT_DOUBLE_EQ(score.recall, 0.5);
  EXPECT_DOUBLE_EQ(score.mean_iou, 0.4);
  EXPECT_DOUBLE_EQ(score.cover, 0.4);
  EXPECT_DOUBLE_EQ(score.waste, 9600.0 / 307200 / 2);
}

TEST(ScoreBoxes, LeavesOutHiddenAndSmallPeople) {
  const std::vector<PeopleFrame> truth{{0, {}},
                                       {5, {{{0, 0, 100, 100}, 0.5, 9000}, {{0, 0, 40, 40}, 1, 1600}}}};
  EXPECT_EQ(score_boxes(truth, {}, {640, 480}).people, 0U);
}

TEST(ScoreBoxes, KnowsThePicturesSize) {
  const std::vector<PeopleFrame> truth{frame_at(0, {0, 0, 1, 1}), frame_at(2, {1000, 500, 1200, 700})};
  const std::vector<PredictedFrame> predictions{{2, {{1000, 500, 1200, 720}}}};
  EXPECT_EQ(score_boxes(truth, predictions, {1280, 720}).people, 0U);  // 5000 px are too few of so many
  const std::vector<PeopleFrame> large{truth[0], {2, {{{1000, 500, 1200, 700}, 0.9, 20000}}}};
  EXPECT_DOUBLE_EQ(score_boxes(large, predictions, {1280, 720}).cover, 1);
}

TEST(ReadPredictions, NamesTheBadLine) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "p.jsonl", "{\"stamp\": 1, \"boxes\": []}\n\n{\"stamp\": 2}\n");
  EXPECT_THAT(read_predictions(folder / "p.jsonl").error(), HasSubstr("p.jsonl:3: expected"));
  test::write_text(folder / "p.jsonl",
                   "{\"stamp\": 2, \"boxes\": []}\n{\"stamp\": \"1.5\", \"boxes\": []}\n");
  EXPECT_EQ(read_predictions(folder / "p.jsonl")->front().time_s, 1.5);
}

class RunScoreTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = new test::TemporaryFolder();
    test::make_scored_run(folder->path());
  }
  static void TearDownTestSuite() { delete folder; }
  static RunScoreInput input() { return {*folder / "dataset", *folder / "run", *folder / "background", 5}; }
  static std::string error_with(const std::string& file, const std::string& text) {
    const test::TemporaryFolder copy;
    std::filesystem::copy(folder->path() / "run", copy.path(), std::filesystem::copy_options::recursive);
    test::write_text(copy / file, text);
    const auto figures = score_run({*folder / "dataset", copy.path(), *folder / "background", 5});
    return figures ? "" : figures.error();
  }
  static test::TemporaryFolder* folder;
};
test::TemporaryFolder* RunScoreTest::folder = nullptr;

TEST_F(RunScoreTest, GivesEveryFigure) {
  const auto figures = score_run(input());
  ASSERT_TRUE(figures) << figures.error();
  EXPECT_DOUBLE_EQ(figures->at("tracked").get<double>(), 39.0 / 40);
  EXPECT_NEAR(figures->at("ate_final").get<double>(), 0.017, 0.004);
  EXPECT_GT(figures->at("box_recall").get<double>(), 0.4);
  EXPECT_GT(figures->at("static_recall").get<double>(), 0.8);
  EXPECT_GT(figures->at("residue").get<double>(), 0.05);
  EXPECT_THAT(to_text(*figures),
              AllOf(HasSubstr("tracked            0.9750\n"), HasSubstr("resolution         0.0500\n")));
  EXPECT_EQ(figures->size(), 20U);
}

TEST_F(RunScoreTest, LeavesOutWhatIsNotThere) {
  auto no_background = input();
  no_background.background.reset();
  EXPECT_FALSE(score_run(no_background)->contains("residue"));
}

TEST_F(RunScoreTest, NamesBadInput) {
  EXPECT_THAT(error_with("trajectory.txt", "1 2 3\n"), HasSubstr("trajectory.txt:1: expected"));
  EXPECT_THAT(error_with("trajectory.txt", ""), HasSubstr("at least 3 poses"));
  EXPECT_THAT(error_with("frames.csv", "stamp\n1\n"), HasSubstr("frames.csv:1: expected a column"));
  EXPECT_THAT(error_with("frames.csv", "total_ms,predict_ms\n1,2\n1,x\n"),
              HasSubstr("frames.csv:3: expected a number"));
  EXPECT_THAT(error_with("map.ot", "x"), HasSubstr("map.ot: no OctoMap"));
  EXPECT_THAT(
      error_with("keyframes.txt", "10.0 9 0 0 0 0 0 1\n10.066667 0 90 0 0 0 0 1\n10.133334 0 0 9 0 0 0 1\n"),
      HasSubstr("keyframes.txt: "));
  EXPECT_THAT(score_run({*folder / "dataset", *folder / "none", {}, 5}).error(), HasSubstr("no such folder"));
  EXPECT_THAT(score_run({*folder / "run", *folder / "run", {}, 5}).error(), HasSubstr("rgb.txt"));
}

}  // namespace
}  // namespace rds::evaluation
