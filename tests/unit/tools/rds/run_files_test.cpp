// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/run/results/run_files.hpp"

#include <gmock/gmock.h>

#include "tests/support/file_size_limit.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/rds/run/output/result_file.hpp"
#include "tools/rds/run/results/mjpeg_avi.hpp"

namespace rds::run {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

geometry::Pose at(double x) {
  geometry::Pose pose = geometry::Pose::Identity();
  pose.translation().x() = x;
  return pose;
}

Recording two_frames() {
  Recording r;
  r.frames[1'000'000'000] = {.stamp_ns = 1'000'000'000,
                             .state = "TRACKING",
                             .has_pose = true,
                             .reference_keyframe_id = 4,
                             .map_from_camera = at(1),
                             .reference_from_camera = at(0.5)};
  r.frames[1'033'000'000] = {.stamp_ns = 1'033'000'000, .state = "LOST", .has_pose = false};
  r.keyframes[4] = {900'000'000, at(10)};
  r.predictions[1'000'000'000] = {
      {.id = 7, .label = "person", .box = {1, 2, 3.456, 4}, .volume = {}, .age_s = 0.1}};
  r.predictions[1'033'000'000] = {};
  r.detections[900'000'000] = {{"person", 0.9, {1, 2, 3, 4}, 1.5}};
  return r;
}

class RunFilesTest : public ::testing::Test {
 protected:
  void SetUp() override { write_run_files(two_frames(), place_.path(), true); }
  std::string text(const std::string& file) const { return test::read_text(place_ / file); }
  test::TemporaryFolder place_;
};

TEST_F(RunFilesTest, TrajectoriesHoldFramesWithAPoseOnly) {
  EXPECT_THAT(text("trajectory.txt"), HasSubstr("1.000000 1.000000000 "));
  EXPECT_THAT(text("trajectory.txt"), Not(HasSubstr("1.033")));
}

TEST_F(RunFilesTest, OptimizedTrajectoryFollowsTheReferenceKeyframe) {
  EXPECT_THAT(text("trajectory_optimized.txt"), HasSubstr("1.000000 10.500000000 "));
  EXPECT_THAT(text("keyframes.txt"), HasSubstr("0.900000 10.000000000 "));
}

TEST(InFirstCamera, EveryMapHasItsOwn) {
  Recording recording = two_frames();
  const auto add = [&](std::int64_t stamp_ns, double x, std::uint64_t epoch) {
    FrameRecord& frame = recording.frames[stamp_ns];
    frame.stamp_ns = stamp_ns;
    frame.has_pose = true;
    frame.map_from_camera = at(x);
    frame.map_epoch = epoch;
  };
  add(1'066'000'000, 3, 0);
  add(2'000'000'000, 7, 1);
  add(2'033'000'000, 7.5, 1);
  std::vector<double> x;
  for (const auto& pose : in_first_camera(live_trajectory(recording), recording))
    x.push_back(pose.map_from_camera.translation().x());
  EXPECT_THAT(x, testing::ElementsAre(0, 2, 0, 0.5));
}

TEST_F(RunFilesTest, AFrameAtAKeyframeOfASavedMapKeepsItsPose) {
  Recording recording = two_frames();
  recording.frames.begin()->second.reference_keyframe_id = 3;  // the run's own begin at 4
  EXPECT_EQ(optimized_trajectory(recording).at(0).map_from_camera.translation().x(), 1);
  recording.frames.begin()->second.reference_keyframe_id = 5;
  EXPECT_EQ(optimized_trajectory(recording).at(0).map_from_camera.translation().x(), 1)
      << "nor is a frame lost whose keyframe was, with a tracker that was killed";
}

TEST_F(RunFilesTest, AFrameOfATrackerThatDiedKeepsItsPose) {
  Recording recording = two_frames();
  recording.map_epoch = 8;  // in which another keyframe has the same id
  EXPECT_EQ(optimized_trajectory(recording).at(0).map_from_camera.translation().x(), 1);
}

TEST_F(RunFilesTest, TablesHaveALinePerFrame) {
  EXPECT_THAT(text("frames.csv"), HasSubstr("1.000000,TRACKING,0,0,0,0.000,0.000,0.000,0.000,1\n"));
  EXPECT_THAT(text("frames.csv"), HasSubstr("1.033000,LOST,"));
  EXPECT_THAT(
      text("predictions.jsonl"),
      HasSubstr(R"({"stamp": 1.000000, "boxes": [{"id":7,"label":"person","box":[1.0,2.0,3.46,4.0])"));
  EXPECT_THAT(text("predictions.jsonl"), HasSubstr(R"({"stamp": 1.033000, "boxes": []})"));
  EXPECT_THAT(text("detections.jsonl"), HasSubstr(R"("score":0.9,"box":[1.0,2.0,3.0,4.0],"depth_m":1.5)"));
}

/// Where a disk is full nothing looks like a result.
TEST(RunFilesOnAFullDisk, EveryWriterSaysWhichFileHasNoRoom) {
  const test::TemporaryFolder place;
  const auto fault = [](const auto& write) -> std::string {
    const test::FileSizeLimit limit(100);
    try {
      write();
    } catch (const std::runtime_error& e) {
      return e.what();
    }
    return "";
  };
  Recording recording;  // without poses: trajectories are short enough
  for (int i = 0; i < 20; ++i) recording.frames[i] = {.stamp_ns = i, .state = "LOST", .has_pose = false};
  EXPECT_THAT(fault([&] { write_run_files(recording, place.path(), true); }),
              HasSubstr("frames.csv: cannot be written"));
  recording.frames.clear();
  recording.detections[1] = two_frames().detections.begin()->second;
  recording.detections[2] = recording.detections[1];
  EXPECT_THAT(fault([&] { write_run_files(recording, place.path(), true); }),
              HasSubstr("detections.jsonl: cannot be written"));
  EXPECT_THAT(fault([&] { write_result(place / "summary.json", std::string(200, ' ')); }),
              HasSubstr("summary.json: cannot be written"));
  EXPECT_THAT(fault([&] { write_picture(place / "map.png", cv::Mat::zeros(50, 50, CV_8UC3)); }),
              HasSubstr("map.png: cannot be written"));
  EXPECT_THAT(fault([&] {
                MjpegAvi video(place / "overlay.avi", 30);
                video.add(cv::Mat::zeros(50, 50, CV_8UC3));
                video.close();
              }),
              HasSubstr("overlay.avi: cannot be written"));
}

}  // namespace
}  // namespace rds::run
