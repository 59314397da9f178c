// SPDX-License-Identifier: Apache-2.0
// Folders of known benchmarks, by their layout.
#include <gmock/gmock.h>
#include <opencv2/imgcodecs.hpp>

#include "tests/support/temporary_folder.hpp"
#include "tools/recording/open_recording.hpp"

namespace rds::recording {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

TEST(Benchmarks, SevenScenes) {
  const test::TemporaryFolder folder;
  cv::Mat1w depth(480, 640, std::uint16_t{65535});
  depth(7, 5) = 2500;
  for (const char* number : {"000000", "000001"}) {
    const std::string stem = std::string("frame-") + number;
    cv::imwrite((folder / (stem + ".color.png")).string(), cv::Mat3b(480, 640, cv::Vec3b(1, 2, 3)));
    cv::imwrite((folder / (stem + ".depth.png")).string(), depth);
    test::write_text(folder / (stem + ".pose.txt"), "1 0 0 0.5\n0 1 0 0\n0 0 1 -2\n0 0 0 1\n");
  }
  const auto opened = open_recording(folder.path());
  ASSERT_TRUE(opened) << opened.error();
  const auto& recording = *opened->recording;
  ASSERT_EQ(recording.frames().size(), 2U);
  EXPECT_EQ(recording.frames()[1].stamp_ns - recording.frames()[0].stamp_ns, 33'333'333);
  EXPECT_EQ(recording.camera().fx, 585);
  const auto frame = recording.load(recording.frames()[1]);
  ASSERT_TRUE(frame) << frame.error();
  EXPECT_FLOAT_EQ(frame->depth.at(5, 7), 2.5F);
  EXPECT_EQ(frame->depth.at(6, 7), 0) << "65535 is no measurement";
  ASSERT_EQ(recording.ground_truth()->size(), 2U);
  EXPECT_EQ((*recording.ground_truth())[1].map_from_camera.translation(), Eigen::Vector3d(0.5, 0, -2));
}

TEST(Benchmarks, IclNuimIsMirrored) {
  const test::TemporaryFolder folder;
  fs::create_directories(folder / "rgb");
  fs::create_directories(folder / "depth");
  for (int i = 0; i < 2; ++i) {
    const std::string name = std::to_string(i) + ".png";
    cv::imwrite((folder / "rgb" / name).string(), cv::Mat3b(480, 640, cv::Vec3b(1, 2, 3)));
    cv::imwrite((folder / "depth" / name).string(), cv::Mat1w(480, 640, std::uint16_t{5000}));
  }
  test::write_text(folder / "associations.txt", "0 depth/0.png 0 rgb/0.png\n1 depth/1.png 1 rgb/1.png\n");
  test::write_text(folder / "livingRoom0.gt.freiburg", "0 0 0 0 0 0 0 1\n1 1 2 3 0.6 0 0 0.8\n");
  const auto opened = open_recording(folder.path());
  ASSERT_TRUE(opened) << opened.error();
  const auto& recording = *opened->recording;
  ASSERT_EQ(recording.frames().size(), 2U);
  EXPECT_EQ(recording.camera().fy, 480);
  EXPECT_FLOAT_EQ(recording.load(recording.frames()[0])->depth.at(5, 7), 1);
  const auto& pose = (*recording.ground_truth())[1];
  EXPECT_EQ(pose.stamp_ns, recording.frames()[1].stamp_ns);
  EXPECT_EQ(pose.map_from_camera.translation(), Eigen::Vector3d(1, -2, 3));
  const Eigen::Quaterniond expected(0.8, -0.6, 0, 0);
  EXPECT_TRUE(pose.map_from_camera.linear().isApprox(expected.toRotationMatrix(), 1e-9));
  test::write_text(folder / "associations.txt", "0 depth/0.png\n");
  EXPECT_THAT(open_recording(folder.path()).error(), HasSubstr("associations.txt:1: expected"));
}

TEST(Benchmarks, ReplicaAsRenderedForNiceSlam) {
  const test::TemporaryFolder folder;
  fs::create_directories(folder / "results");
  for (const char* number : {"000000", "000001"}) {
    cv::imwrite((folder / "results" / (std::string("frame") + number + ".jpg")).string(),
                cv::Mat3b(680, 1200, cv::Vec3b(1, 2, 3)));
    cv::imwrite((folder / "results" / (std::string("depth") + number + ".png")).string(),
                cv::Mat1w(680, 1200, std::uint16_t{13107}));
  }
  test::write_text(folder / "traj.txt", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n1 0 0 2 0 1 0 3 0 0 1 4 0 0 0 1\n");
  const auto opened = open_recording(folder.path());
  ASSERT_TRUE(opened) << opened.error();
  const auto& recording = *opened->recording;
  ASSERT_EQ(recording.frames().size(), 2U);
  EXPECT_EQ(recording.camera().cx, 599.5);
  EXPECT_FLOAT_EQ(recording.load(recording.frames()[1])->depth.at(5, 7), 2);
  EXPECT_EQ((*recording.ground_truth())[1].map_from_camera.translation(), Eigen::Vector3d(2, 3, 4));
}

class ScanNet : public testing::Test {
 protected:
  ScanNet() {
    for (const char* part : {"color", "depth", "pose", "intrinsic"}) fs::create_directories(folder_ / part);
    cv::Mat3b color(96, 128, cv::Vec3b(0, 0, 0));
    color(cv::Rect(80, 40, 16, 16)) = cv::Vec3b(255, 255, 255);
    for (const char* number : {"0", "1", "10"}) {
      const auto file = [&](const char* part, const char* ending) {
        return (folder_ / part / (std::string(number) + ending)).string();
      };
      cv::imwrite(file("color", ".jpg"), color);
      cv::imwrite(file("depth", ".png"), cv::Mat1w(48, 64, std::uint16_t{1500}));
      test::write_text(file("pose", ".txt"), number == std::string("1") ? kLost : kFound);
    }
    test::write_text(folder_ / "intrinsic/intrinsic_color.txt", "120 0 64 0\n0 120 48 0\n0 0 1 0\n0 0 0 1\n");
    test::write_text(folder_ / "intrinsic/intrinsic_depth.txt", "60 0 30 0\n0 60 20 0\n0 0 1 0\n0 0 0 1\n");
  }
  static constexpr const char* kFound = "1 0 0 0.5\n0 1 0 0\n0 0 1 -2\n0 0 0 1\n";
  static constexpr const char* kLost =
      "-inf -inf -inf -inf\n-inf -inf -inf -inf\n-inf -inf -inf -inf\n-inf -inf -inf -inf\n";
  test::TemporaryFolder folder_;
};

TEST_F(ScanNet, ThePictureIsThatOfTheDepthCamera) {
  const auto opened = open_recording(folder_.path());
  ASSERT_TRUE(opened) << opened.error();
  const auto& recording = *opened->recording;
  ASSERT_EQ(recording.frames().size(), 3U);
  EXPECT_EQ(recording.frames()[2].stamp_ns, 1'333'333'333) << "number 10";
  EXPECT_EQ(recording.camera().width, 64);
  EXPECT_EQ(recording.camera().cy, 20);
  const auto frame = recording.load(recording.frames()[0]);
  ASSERT_TRUE(frame) << frame.error();
  EXPECT_FLOAT_EQ(frame->depth.at(5, 7), 1.5F);
  const cv::Mat bgr = frame->color.bgr();
  EXPECT_GT(bgr.at<cv::Vec3b>(20, 42)[0], 200)
      << "colour's pixel 88, 48: (88 - 64) / 120 to the right, level";
  EXPECT_LT(bgr.at<cv::Vec3b>(20, 30)[0], 50);
  ASSERT_EQ(recording.ground_truth()->size(), 2U) << "where it was lost there is no pose";
}

TEST_F(ScanNet, WithoutACameraItIsRefused) {
  test::write_text(folder_ / "intrinsic/intrinsic_color.txt", "none");
  EXPECT_THAT(open_recording(folder_.path()).error(),
              HasSubstr("intrinsic_color.txt: expected a 4×4 matrix"));
}

}  // namespace
}  // namespace rds::recording
