// SPDX-License-Identifier: Apache-2.0
#include "services/viewer/scene_frames.hpp"

#include <limits>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "common/messages/detection_conversions.hpp"
#include "tests/unit/services/viewer/frame_reader.hpp"

namespace rds::viewer {
namespace {

using nlohmann::json;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

json content(const Bytes& frame, Kind kind) {
  test::FrameReader in(frame);
  EXPECT_EQ(in.kind(), kind);
  return json::parse(in.rest());
}

rds_msgs::msg::PredictedBoxes two_boxes() {
  rds_msgs::msg::PredictedBoxes boxes;
  boxes.ids({4, 9});
  boxes.labels({"person", "dog"});
  boxes.scores({0.5F, 0.25F});
  boxes.boxes({1, 2, 3, 4, 5, 6, 7, 8});
  boxes.minimums({0, 0, 0, 1, 1, 1});
  boxes.maximums({2, 2, 2, 3, 3, 3});
  boxes.velocities({0.5, 0, 0, 0, 0, 0});
  boxes.covariance_traces({1, 1});
  boxes.ages({0, 0.1});
  return boxes;
}

TEST(SceneFrames, BoxesHaveIdsLabelsAndVelocities) {
  const json told = content(boxes_frame(two_boxes()).value(), Kind::kBoxes);
  ASSERT_EQ(told.size(), 2U);
  EXPECT_EQ(told[1]["id"], 9);
  EXPECT_EQ(told[0]["label"], "person");
  EXPECT_EQ(told[0]["movable"], true);
  EXPECT_EQ(told[0]["velocity"], json({0.5, 0.0, 0.0}));
  EXPECT_EQ(told[1]["image"], json({5.0, 6.0, 7.0, 8.0}));
}

TEST(SceneFrames, BoxesThatDoNotFitEachOtherAreRefused) {
  auto boxes = two_boxes();
  boxes.velocities({1, 2});
  EXPECT_FALSE(boxes_frame(boxes));
  boxes = two_boxes();
  boxes.minimums({0, 0, 0, 1, 1, std::numeric_limits<double>::infinity()});
  EXPECT_FALSE(boxes_frame(boxes));
}

TEST(SceneFrames, ATrackingStateWithoutAPoseIsRefused) {
  rds_msgs::msg::TrackingState state;
  state.map_from_camera().orientation().w(1);
  state.inliers(99);
  state.total_us(12500);
  const json told = content(tracking_frame(state).value(), Kind::kTracking);
  EXPECT_EQ(told["inliers"], 99);
  EXPECT_DOUBLE_EQ(told["total_ms"], 12.5);
  EXPECT_EQ(told["pose"].size(), 7U);
  state.map_from_camera().position().x(std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(tracking_frame(state));
}

TEST(SceneFrames, LabelsThatAreNoTextDoNoHarm) {
  const std::vector<std::string> labels{"", "chair", "\xff\xfe"};
  EXPECT_EQ(content(labels_frame(labels), Kind::kLabels)[1]["name"], "chair");
}

TEST(SceneFrames, AGridHasAsManyCellsAsItSays) {
  nav_msgs::msg::OccupancyGrid grid;
  grid.info().width(3);
  grid.info().height(2);
  grid.info().resolution(0.05F);
  grid.info().origin().orientation().w(1);
  grid.data({-1, 0, 100, 0, 0, 0});
  const Bytes frame = grid_frame(grid).value();
  test::FrameReader in(frame);
  EXPECT_EQ(in.kind(), Kind::kGrid);
  EXPECT_EQ(in.get<std::uint32_t>(), 3U);
  EXPECT_EQ(in.get<std::uint32_t>(), 2U);
  EXPECT_FLOAT_EQ(in.get<float>(), 0.05F);
  for (int i = 0; i < 7; ++i) in.get<float>();
  EXPECT_EQ(in.get<std::int8_t>(), -1);
  EXPECT_EQ(in.rest().size(), 5U);
  grid.info().height(0xffffffff);
  EXPECT_FALSE(grid_frame(grid));
}

TEST(SceneFrames, APictureHasItsFeatures) {
  const Bytes jpeg{0xff, 0xd8, 0xff, 0xd9};
  rds_msgs::msg::FrameFeatures features;
  features.positions({10.4F, 20.6F, kNan, -5});
  features.verdicts({1, 2});
  const Bytes frame = picture_frame(jpeg, 42, 640, 480, &features).value();
  test::FrameReader in(frame);
  EXPECT_EQ(in.kind(), Kind::kPicture);
  EXPECT_EQ(in.get<std::int64_t>(), 42);
  EXPECT_EQ(in.get<std::uint32_t>(), 640U);
  EXPECT_EQ(in.get<std::uint32_t>(), 480U);
  EXPECT_EQ(in.get<std::uint32_t>(), 4U);
  EXPECT_EQ(in.get<std::uint32_t>(), 2U);
  EXPECT_EQ(in.get<std::uint16_t>(), 10U);
  EXPECT_EQ(in.get<std::uint16_t>(), 20U);
  EXPECT_EQ(in.get<std::uint32_t>(), 1U);
  EXPECT_EQ(in.get<std::uint16_t>(), 0U);
  EXPECT_EQ(in.get<std::uint16_t>(), 0U);
  EXPECT_EQ(in.get<std::uint32_t>(), 2U);
  EXPECT_EQ(in.rest().size(), 4U);
  features.positions({1});
  EXPECT_FALSE(picture_frame(jpeg, 42, 640, 480, &features));
  EXPECT_TRUE(picture_frame(jpeg, 42, 640, 480, nullptr));
}

TEST(SceneFrames, KeyframesStandInRowsOfFortyBytes) {
  std::vector<geometry::KeyframePose> keyframes(2);
  keyframes[1].id = 7;
  keyframes[1].map_from_camera.translation() = Eigen::Vector3d(1, 2, 3);
  const Bytes frame = keyframes_frame(Kind::kKeyframes, keyframes, std::vector<Loop>{{7, 0}});
  EXPECT_EQ(frame.size(), 8U + 8 + 2 * 40 + 16);
  test::FrameReader in(frame);
  EXPECT_EQ(in.kind(), Kind::kKeyframes);
  EXPECT_EQ(in.get<std::uint32_t>(), 2U);
  EXPECT_EQ(in.get<std::uint32_t>(), 1U);
}

}  // namespace
}  // namespace rds::viewer
