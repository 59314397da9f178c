// SPDX-License-Identifier: Apache-2.0
#include "tools/evaluation/objects/object_score.hpp"

#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "common/labels/table.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/evaluation/objects/object_file.hpp"
#include "tools/evaluation/objects/upright_iou.hpp"

namespace rds::evaluation {
namespace {

using geometry::OrientedBox;
using testing::HasSubstr;

OrientedBox box_at(const Eigen::Vector3d& center, const Eigen::Vector3d& size, double yaw_rad = 0) {
  return {
      geometry::make_pose(center, Eigen::Quaterniond(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()))),
      size};
}

TEST(UprightIou, IsOneForABoxAndItself) {
  const OrientedBox box = box_at({100, -7, 1}, {1.4, 0.8, 0.7}, 0.6);
  EXPECT_NEAR(upright_iou(box, box), 1, 1e-4);
  EXPECT_NEAR(upright_iou(box, box_at({100, -7, 1}, {0.8, 1.4, 0.7}, 0.6 + std::numbers::pi / 2)), 1, 1e-4);
}

TEST(UprightIou, OfASquareTurnedByFortyFiveDegrees) {
  const double octagon = 2 * (std::sqrt(2) - 1);
  EXPECT_NEAR(upright_iou(box_at({0, 0, 0}, {1, 1, 1}), box_at({0, 0, 0}, {1, 1, 1}, std::numbers::pi / 4)),
              octagon / (2 - octagon), 1e-4);
}

TEST(UprightIou, CountsTheCommonHeight) {
  EXPECT_NEAR(upright_iou(box_at({0, 0, 0}, {1, 1, 1}), box_at({0, 0, 0.5}, {1, 1, 1})), 1.0 / 3, 1e-4);
  EXPECT_EQ(upright_iou(box_at({0, 0, 0}, {1, 1, 1}), box_at({0, 0, 1.1}, {1, 1, 1})), 0);
  EXPECT_EQ(upright_iou(box_at({0, 0, 0}, {1, 1, 1}), box_at({3, 0, 0}, {1, 1, 1})), 0);
  EXPECT_EQ(upright_iou(box_at({0, 0, 0}, {0, 0, 0}), box_at({0, 0, 0}, {0, 0, 0})), 0);
}

TEST(ReadThings, TakesTheOrientedBoxWhereThereIsOneAndLeavesOutWhatHasGone) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "objects.json", R"([
    {"label": "chair", "center": [1, 2, 3], "size": [1, 1, 1]},
    {"label": "sofa", "center": [0, 0, 0], "size": [9, 9, 9], "gone": false,
     "oriented": {"center": [1, 0, 0], "size": [2, 1, 1], "yaw": 0.5}},
    {"label": "sofa", "center": [0, 0, 0], "size": [9, 9, 9],
     "oriented": {"center": [1, 0, 0], "size": [2, 1, 1], "yaw": 9, "orientation": [0, 0, 0.6, 0.8]}},
    {"label": "bottle", "center": [0, 0, 0], "size": [1, 1, 1], "gone": true}])");
  const auto things = read_things(folder / "objects.json");
  ASSERT_TRUE(things) << things.error();
  ASSERT_EQ(things->size(), 3U);
  EXPECT_EQ(things->at(0).box.center(), Eigen::Vector3d(1, 2, 3));
  EXPECT_TRUE(things->at(1).box.map_from_box.isApprox(box_at({1, 0, 0}, {1, 1, 1}, 0.5).map_from_box));
  EXPECT_NEAR(things->at(2).box.map_from_box.linear()(1, 0), 0.96, 1e-12);
  EXPECT_EQ(things->at(2).box.size, Eigen::Vector3d(2, 1, 1));
  test::write_text(folder / "objects.json", R"([{"label": "chair", "center": [1, 2]}])");
  EXPECT_THAT(read_things(folder / "objects.json").error(), HasSubstr("objects.json: expected [{\"label\""));
}

/// A camera at the origin that looks along x at a chair and a bottle; a sofa behind it.
class ScoreObjects : public testing::Test {
 protected:
  ScoreObjects() {
    test::write_text(dataset() / "camera.yaml",
                     "width: 640\nheight: 480\nfx: 525.0\nfy: 525.0\ncx: 319.5\ncy: 239.5\n"
                     "distortion: [0, 0, 0, 0, 0]\ndepth_scale: 1000.0\nfps: 30\n");
    test::write_text(dataset() / "groundtruth.txt",
                     "1.0 0 0 0 -0.5 0.5 -0.5 0.5\n9.0 0 0 0 -0.5 0.5 -0.5 0.5\n");
    test::write_text(dataset() / "objects.json", R"([
      {"label": "chair", "center": [2, 0, 0], "size": [0.5, 0.6, 1]},
      {"label": "bottle", "center": [2, 0.6, 0], "size": [0.1, 0.1, 0.3]},
      {"label": "sofa", "center": [-3, 0, 0], "size": [1, 2, 1]}])");
    const std::string boxes = R"({"label": "chair", "box": [229.5, 91, 409.5, 389], "depth_m": 2}, )"
                              R"({"label": "bottle", "box": [150, 199, 177, 280], "depth_m": 2})";
    std::string seen;
    for (int n = 0; n < 40; ++n)
      seen += fmt::format("{{\"stamp\": {:.1f}, \"detections\": [{}]}}\n", 1 + 0.1 * n, boxes);
    test::write_text(dataset() / "detections_truth.jsonl", seen);
    detector_names("chair");
    found(R"({"label": "chair", "center": [2.05, 0, 0], "size": [0.5, 0.6, 1]})");
  }
  [[nodiscard]] std::filesystem::path dataset() const { return folder_ / "dataset"; }
  [[nodiscard]] std::filesystem::path out() const { return folder_ / "out"; }
  void detector_names(const std::string& label) {
    test::write_text(
        out() / "detections.jsonl",
        fmt::format(R"({{"stamp": 1.0, "detections": [{{"label": "{}", "box": [0, 0, 9, 9]}}]}})", label) +
            "\n");
  }
  void found(const std::string& objects) { test::write_text(out() / "objects.json", "[" + objects + "]"); }
  ObjectScore score(const MapVoxels& voxels = {{}, {}, 0.05}) {
    const auto score = score_objects({dataset(), out(), geometry::Pose::Identity(), voxels});
    EXPECT_TRUE(score) << score.error();
    return score.value_or(ObjectScore{});
  }

 private:
  struct Folders : test::TemporaryFolder {
    Folders() {
      for (const char* name : {"dataset", "out"}) std::filesystem::create_directories(*this / name);
    }
  };
  Folders folder_;
};

TEST_F(ScoreObjects, AsksForWhatShowedAndWhatTheDetectorKnows) {
  const ObjectScore score = this->score();
  EXPECT_EQ(score.wanted, 1U) << "the bottle was never named, the sofa never seen";
  EXPECT_EQ(score.found, 1U);
  EXPECT_EQ(score.wrong, 0U);
  EXPECT_DOUBLE_EQ(score.f1, 1);
  EXPECT_NEAR(score.iou, 0.45 / 0.55, 1e-4);
}

TEST_F(ScoreObjects, CountsWhatIsMissingAndWhatIsWrong) {
  found(R"({"label": "chair", "center": [2.2, 0, 0], "size": [0.5, 0.6, 1]},
           {"label": "sofa", "center": [-2.5, 0, 0], "size": [1, 1, 1]})");
  const ObjectScore score = this->score();
  EXPECT_EQ(score.wanted, 1U);
  EXPECT_EQ(score.found, 0U) << "20 cm off";
  EXPECT_EQ(score.wrong, 2U);
  EXPECT_DOUBLE_EQ(score.f1, 0);
}

TEST_F(ScoreObjects, OfWhatTheTruthHasNoNameNothingIsSaid) {
  found(R"({"label": "book", "center": [-2.5, 0, 0], "size": [1, 1, 1]})");
  EXPECT_EQ(score().wrong, 0U);
  found(R"({"label": "bottle", "center": [-2.5, 0, 0], "size": [1, 1, 1]})");
  EXPECT_EQ(score().wrong, 1U) << "it names bottles, and there is none";
}

TEST_F(ScoreObjects, WhatIsFoundOfAThingThatHardlyShowedIsNeitherRightNorWrong) {
  std::string one_line = R"({"stamp": 1, "detections": [{"label": "chair", "box": [0, 0, 9, 9]}, )";
  one_line += R"({"label": "sofa", "box": [0, 0, 9, 9]}]})";
  test::write_text(out() / "detections.jsonl", one_line + "\n");
  found(R"({"label": "chair", "center": [2, 0, 0], "size": [0.5, 0.6, 1]},
           {"label": "sofa", "center": [-2.5, 0, 0], "size": [1, 1, 1]})");
  EXPECT_EQ(score().wrong, 0U);
  EXPECT_DOUBLE_EQ(score().f1, 1);
}

TEST_F(ScoreObjects, LooksAtTheLabelsOfVoxels) {
  const auto chair = *labels::Table()["chair"].color;
  MapVoxels voxels{{}, {}, 0.05};
  const auto add = [&](double x, double y, const std::array<std::uint8_t, 3>& color) {
    voxels.centers.emplace_back(x, y, 0);
    voxels.colors.push_back(color);
  };
  add(1.95, 0, chair);
  add(2, 0.1, chair);
  add(2, -0.1, {1, 2, 3});  // in the chair, without its label
  add(2.28, 0, chair);      // in the box of the found one, and a voxel's width beside the true one
  add(2.05, 0.29, chair);
  add(2.05, 5, chair);                       // in nobody's box
  voxels.centers.emplace_back(2, 0, -0.49);  // of the floor
  voxels.colors.push_back({1, 2, 3});
  const ObjectScore score = this->score(voxels);
  EXPECT_DOUBLE_EQ(score.labelled, 3.0 / 4);
  EXPECT_DOUBLE_EQ(score.label_true, 1);
  found(R"({"label": "chair", "center": [2.1, 0, 0], "size": [0.5, 0.6, 1]})");
  voxels.centers.back() = {2.34, 0, 0};  // in the box of the found one, but of nothing
  voxels.colors.back() = chair;
  EXPECT_DOUBLE_EQ(this->score(voxels).label_true, 4.0 / 5);
}

TEST_F(ScoreObjects, NamesTheLineThatCannotBeRead) {
  test::write_text(dataset() / "detections_truth.jsonl",
                   "{\"stamp\": 1, \"detections\": []}\n{\"stamp\": 2}\n");
  const auto score = score_objects({dataset(), out(), geometry::Pose::Identity(), {}});
  ASSERT_FALSE(score);
  EXPECT_THAT(score.error(), HasSubstr("detections_truth.jsonl:2: expected"));
}

}  // namespace
}  // namespace rds::evaluation
