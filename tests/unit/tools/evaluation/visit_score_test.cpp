// SPDX-License-Identifier: Apache-2.0
#include "tools/evaluation/visits/visit_score.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <opencv2/imgcodecs.hpp>

#include "tests/support/temporary_folder.hpp"
#include "tools/evaluation/visits/moved_pieces.hpp"

namespace rds::evaluation {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kVoxelM = 0.05;
constexpr double kWallM = 3.025;  // middles of voxels
constexpr double kBoxM = 2.025;
constexpr double kSideM = 0.5;
constexpr double kFocalPx = 525;

using Points = std::vector<Eigen::Vector3d>;

/// The middles of a rectangle's voxels that faces the camera.
Points face(double x, double y, double z, double width, double height) {
  Points points;
  for (double right = x + kVoxelM / 2; right < x + width; right += kVoxelM)
    for (double down = y + kVoxelM / 2; down < y + height; down += kVoxelM)
      points.emplace_back(right, down, z);
  return points;
}

Points with(Points points, const Points& others) {
  points.insert(points.end(), others.begin(), others.end());
  return points;
}

Points wall() {
  return face(-1.5, -1, kWallM, 3, 2);
}
Points box(double x) {
  return face(x, 0, kBoxM, kSideM, kSideM);
}

/// A camera at the origin sees a wall and a box before it, four times.
class ScoreVisit : public testing::Test {
 protected:
  Visit visit(const std::string& name, double x) const {
    const auto folder = place / name;
    std::filesystem::create_directories(folder / "depth");
    cv::Mat depth(480, 640, CV_16UC1, cv::Scalar(1000 * kWallM));
    const auto pixel = [](double m) { return static_cast<int>(kFocalPx * m / kBoxM); };
    depth(cv::Rect(320 + pixel(x), 240, pixel(kSideM), pixel(kSideM))).setTo(1000 * kBoxM);
    std::string list;
    for (int n = 1; n <= 4; ++n) {
      const std::string file = fmt::format("depth/{}.png", n);
      cv::imwrite((folder / file).string(), depth);
      list += fmt::format("{}.0 {}\n", n, file);
    }
    test::write_text(folder / "depth.txt", list);
    test::write_text(folder / "groundtruth.txt", "1.0 0 0 0 0 0 0 1\n4.0 0 0 0 0 0 0 1\n");
    test::write_text(folder / "camera.yaml",
                     "width: 640\nheight: 480\nfx: 525.0\nfy: 525.0\ncx: 319.5\ncy: 239.5\n"
                     "distortion: [0, 0, 0, 0, 0]\ndepth_scale: 1000.0\nfps: 30\n");
    return {folder, with(wall(), box(x))};
  }

  test::TemporaryFolder place;
  Visit yesterday = visit("yesterday", -0.9);
  Visit today = visit("today", 0.3);
};

TEST_F(ScoreVisit, AMapOfTodayHasWhatWasMovedInItsPlace) {
  const auto score = score_visit({today, {yesterday}, today.surfaces, kVoxelM, 1});
  ASSERT_TRUE(score) << score.error();
  EXPECT_EQ(score->recall, 1);
  EXPECT_EQ(score->precision, 1);
  EXPECT_EQ(score->moved_from, 1U);
  EXPECT_EQ(score->moved_from_free, 1U);
  EXPECT_EQ(score->moved_to, 1U);
  EXPECT_EQ(score->moved_to_mapped, 1U);
}

TEST_F(ScoreVisit, AMapOfYesterdayHasItWhereItWas) {
  const auto score = score_visit({today, {yesterday}, yesterday.surfaces, kVoxelM, 1});
  ASSERT_TRUE(score) << score.error();
  EXPECT_LT(score->recall, 0.98);
  EXPECT_LT(score->precision, 0.98);
  EXPECT_EQ(score->moved_from, 1U);
  EXPECT_EQ(score->moved_from_free, 0U);
  EXPECT_EQ(score->moved_to, 1U);
  EXPECT_EQ(score->moved_to_mapped, 0U);
}

TEST_F(ScoreVisit, WhatTheCamerasDoNotSeeIsNotAsked) {
  Visit before = yesterday;
  before.surfaces = with(before.surfaces, face(-0.25, 0, -2.025, kSideM, kSideM));  // behind the camera
  const Points map = with(today.surfaces, face(0, 0, 3.525, kSideM, kSideM));       // behind the wall
  const auto score = score_visit({today, {before}, map, kVoxelM, 1});
  ASSERT_TRUE(score) << score.error();
  EXPECT_EQ(score->precision, 1);
  EXPECT_EQ(score->moved_from, 1U);
}

TEST_F(ScoreVisit, OfTwoEarlierDaysEachCounts) {
  const Visit before = visit("before", -0.2);
  const auto score = score_visit({today, {before, yesterday}, today.surfaces, kVoxelM, 1});
  ASSERT_TRUE(score) << score.error();
  EXPECT_EQ(score->moved_from, 2U);
  EXPECT_EQ(score->moved_from_free, 2U);
  EXPECT_EQ(score->moved_to, 1U);
}

TEST_F(ScoreVisit, SaysWhatCannotBeRead) {
  std::filesystem::remove(yesterday.recording / "depth/3.png");
  const auto score = score_visit({today, {yesterday}, today.surfaces, kVoxelM, 1});
  ASSERT_FALSE(score);
  EXPECT_THAT(score.error(), HasSubstr("yesterday/depth/3.png"));
}

TEST(MovedPieces, HangTogetherByFacesEdgesAndCorners) {
  const VoxelKey a = pack({5, 5, 5});
  const VoxelKey beside = pack({6, 6, 6});
  const VoxelKey far = pack({8, 6, 6});
  const VoxelSet voxels = make_voxel_set({far, a, beside});
  EXPECT_THAT(connected_parts(voxels, 1), ElementsAre(ElementsAre(0, 1), ElementsAre(2)));
  EXPECT_THAT(connected_parts(voxels, 2), ElementsAre(ElementsAre(0, 1)));
  EXPECT_THAT(away_from({a}, voxels, 1), ElementsAre(far));
  EXPECT_THAT(away_from({a}, voxels, 3), ElementsAre());
}

}  // namespace
}  // namespace rds::evaluation
