// SPDX-License-Identifier: Apache-2.0
#include "common/image/tum_dataset.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/shared_data.hpp"
#include "tests/support/small_dataset.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::image {
namespace {
using testing::AllOf;
using testing::HasSubstr;

class TumDatasetTest : public testing::Test {
 protected:
  void SetUp() override { test::make_small_dataset(folder.path(), 5); }
  std::string open_error() const {
    const auto dataset = TumDataset::open(folder.path());
    return dataset ? "" : dataset.error();
  }
  test::TemporaryFolder folder;
};

TEST_F(TumDatasetTest, ReadsWhatTheRobotHasSensed) {
  EXPECT_FALSE(TumDataset::open(folder.path())->sensors().imu);
  test::write_text(folder / "odometry.txt", "10 0 0 0 0 0 0 1\n10.1 0.5 0 0 0 0 0 1\n");
  test::write_text(folder / "imu.txt", "10 0 -9.81 0 0.1 0.2 0.3\n");
  const auto dataset = TumDataset::open(folder.path());
  ASSERT_TRUE(dataset) << dataset.error();
  ASSERT_TRUE(dataset->sensors().imu && dataset->sensors().odometry);
  EXPECT_EQ(dataset->sensors().imu->measurements[0].turn_rate.y(), 0.2);
  EXPECT_EQ(dataset->sensors().odometry->odom_from_body[1].map_from_camera.translation().x(), 0.5);
  EXPECT_TRUE(dataset->sensors().odometry->body_from_camera.isApprox(geometry::Pose::Identity()));
  test::write_text(folder / "odometry.txt", "# none\n");
  EXPECT_THAT(open_error(), AllOf(HasSubstr("odometry.txt"), HasSubstr("at least one pose")));
  test::write_text(folder / "odometry.txt", "10 0 0 0 0 0 0 1\n");
  test::write_text(folder / "imu.txt", "10 down\n");
  EXPECT_THAT(open_error(), HasSubstr("imu.txt:1"));
}

TEST_F(TumDatasetTest, ReadsListsCameraTruthAndPictures) {
  const auto dataset = TumDataset::open(folder.path());
  ASSERT_TRUE(dataset) << dataset.error();
  ASSERT_EQ(dataset->frames().size(), 5U);
  EXPECT_EQ(dataset->frames()[1].stamp_ns, 10033333000);
  EXPECT_EQ(dataset->frames()[1].stamp_text, "10.033333");
  EXPECT_EQ(dataset->stamp_text(10033333000), "10.033333");
  EXPECT_EQ(dataset->camera().fx, 60);
  EXPECT_EQ(dataset->ground_truth()->size(), 5U);
  const auto frame = dataset->load(dataset->frames()[4]);
  ASSERT_TRUE(frame) << frame.error();
  EXPECT_EQ(frame->color.pixels.size(), cv::Size(64, 48));
  EXPECT_GE(frame->depth.at(3, 4), 1.0F);
  EXPECT_LE(frame->depth.at(3, 4), 3.0F);
}

TEST_F(TumDatasetTest, PairsEachDepthOnceAndKeepsColourWithoutDepth) {
  test::write_text(folder / "rgb.txt", "10.000 a\n10.010 b\n10.050 c\n10.099 d\n10.099 d\n");
  test::write_text(folder / "depth.txt", "10.008 A\n10.069 C\n10.140 D\n");
  const auto dataset = TumDataset::open(folder.path());
  ASSERT_TRUE(dataset) << dataset.error();
  ASSERT_EQ(dataset->frames().size(), 4U);
  EXPECT_FALSE(dataset->frames()[0].has_depth());
  EXPECT_EQ(dataset->frames()[0].depth_stamp_ns, 10000000000);
  EXPECT_EQ(dataset->frames()[1].depth_stamp_ns, 10008000000);
  EXPECT_EQ(dataset->depth_list().entries[dataset->frames()[2].depth.value()].picture.filename(), "C");
  EXPECT_EQ(dataset->frames()[2].index, 2U);
  EXPECT_EQ(dataset->without_depth(), 2U);
  EXPECT_EQ(dataset->color_list().repeated, 1U);
}

TEST_F(TumDatasetTest, AFrameWithoutDepthHasAnEmptyDepthPicture) {
  std::string list = test::read_text(folder / "depth.txt");
  const auto third = list.find("10.066");
  list.erase(third, list.find('\n', third) + 1 - third);
  test::write_text(folder / "depth.txt", list);
  const auto dataset = TumDataset::open(folder.path());
  ASSERT_EQ(dataset->without_depth(), 1U);
  const auto frame = dataset->load(dataset->frames()[2]);
  ASSERT_TRUE(frame) << frame.error();
  EXPECT_EQ(frame->depth.values.size(), cv::Size(64, 48));
  EXPECT_EQ(cv::countNonZero(frame->depth.values), 0);
}

TEST_F(TumDatasetTest, NamesFileAndLineOfBadLists) {
  test::write_text(folder / "rgb.txt", "# c\n10.0 rgb/a.jpg\n10.1\n");
  EXPECT_THAT(open_error(), AllOf(HasSubstr("rgb.txt:3: expected"), HasSubstr("\"10.1\"")));
  test::write_text(folder / "rgb.txt", "10.0 a\n\x01\xff garbage here\n");
  EXPECT_THAT(open_error(), HasSubstr("rgb.txt:2: expected"));
  test::write_text(folder / "rgb.txt", "10.0 a\n9.9 b\n");
  EXPECT_THAT(open_error(), AllOf(HasSubstr("rgb.txt:2: stamp 9.9 goes back"), HasSubstr("10.0")));
  test::write_text(folder / "rgb.txt", "# nothing\n");
  EXPECT_THAT(open_error(), HasSubstr("rgb.txt: lists no picture"));
  std::filesystem::remove(folder / "rgb.txt");
  EXPECT_THAT(open_error(), HasSubstr("rgb.txt: cannot be read"));
}

TEST_F(TumDatasetTest, RefusesColourAndDepthOfDifferentRecordings) {
  test::write_text(folder / "depth.txt", "99.0 depth/a.png\n");
  EXPECT_THAT(open_error(), AllOf(HasSubstr("within 20 ms"), HasSubstr("99.0")));
}

TEST_F(TumDatasetTest, NeedsACameraDescription) {
  std::filesystem::remove(folder / "camera.yaml");
  EXPECT_THAT(open_error(), AllOf(HasSubstr("camera.yaml"), HasSubstr("freiburg1")));
  test::write_text(folder / "camera.yaml", "width: 640\n");
  EXPECT_THAT(open_error(), HasSubstr("camera.yaml: height: missing"));
}

TEST_F(TumDatasetTest, KnowsPublishedCamerasByFolder) {
  std::filesystem::remove(folder / "camera.yaml");
  const test::TemporaryFolder other;
  const auto named = other / "rgbd_dataset_freiburg3_walking_static";
  std::filesystem::rename(folder.path(), named);
  const auto dataset = TumDataset::open(named.string() + "/");
  ASSERT_TRUE(dataset) << dataset.error();
  EXPECT_EQ(dataset->camera().fx, 535.4);
  EXPECT_EQ(dataset->depth_scale(), 5000);
  const auto bonn = other / "rgbd_bonn_crowd";
  std::filesystem::rename(named, bonn);
  EXPECT_EQ(TumDataset::open(bonn)->camera().fx, 542.822841);
}

TEST_F(TumDatasetTest, TruthIsOptionalButNeverHalfRead) {
  test::write_text(folder / "groundtruth.txt", "10.0 0 0\n");
  EXPECT_THAT(open_error(), HasSubstr("groundtruth.txt:1: expected"));
  std::filesystem::remove(folder / "groundtruth.txt");
  EXPECT_FALSE(TumDataset::open(folder.path())->ground_truth());
  EXPECT_THAT(TumDataset::open(folder / "none").error(), HasSubstr("no such folder"));
}

TEST_F(TumDatasetTest, OneUnreadablePictureIsAnErrorOfThatFrameOnly) {
  const auto dataset = TumDataset::open(folder.path());
  std::filesystem::resize_file(dataset->color_list().entries[2].picture, 700);
  std::filesystem::remove(dataset->depth_list().entries[3].picture);
  EXPECT_TRUE(dataset->load(dataset->frames()[1]));
  EXPECT_THAT(dataset->load(dataset->frames()[2]).error(), HasSubstr("truncated after 700 bytes"));
  EXPECT_THAT(dataset->load(dataset->frames()[3]).error(), HasSubstr("no such file"));
  EXPECT_TRUE(dataset->load(dataset->frames()[4]));
}

TEST(TumDatasetRecordings, OpensBothRecordings) {
  RDS_REQUIRE_SHARED("data");
  const auto rpy = TumDataset::open(test::shared() / "data/tum_fr1_rpy");
  ASSERT_TRUE(rpy) << rpy.error();
  EXPECT_EQ(rpy->frames().size(), 723U);
  EXPECT_EQ(rpy->without_depth(), 2U);
  const auto kitchen = TumDataset::open(test::shared() / "data/7scenes_kitchen");
  ASSERT_TRUE(kitchen) << kitchen.error();
  EXPECT_EQ(kitchen->frames().size(), 500U);
  EXPECT_TRUE(kitchen->load(kitchen->frames()[250]));
}

}  // namespace
}  // namespace rds::image
