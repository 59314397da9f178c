// SPDX-License-Identifier: Apache-2.0
#include "common/messages/detection_conversions.hpp"
#include "common/messages/keyframe_pose_table.hpp"
#include "tests/unit/services/mapper/mapper_on_the_bus.hpp"

namespace rds::mapper {
namespace {

TEST_F(MapperOnTheBus, BadInputIsDroppedAndCounted) {
  start(config());
  images.write(to_message(SyntheticKeyframe(0).make(), kEpoch - 1));
  ASSERT_TRUE(has_revision(1));
  send(1);  // another epoch, said by one message alone
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  {
    const std::lock_guard lock(mutex);
    EXPECT_EQ(info->map_epoch(), kEpoch - 1) << "it may be spoiled";
  }
  Poses same_epoch;
  same_epoch.map_epoch(kEpoch);
  same_epoch.keyframe_ids({1});
  same_epoch.stamps({0});
  same_epoch.poses({0, 0, 0, 0, 0, 0, 1});
  poses.write(same_epoch);
  ASSERT_TRUE(wait_for([&] {
    const std::lock_guard lock(mutex);
    return info->map_epoch() == kEpoch && info->revision() == 1;
  }));
  const auto rejects = [&](const Images& bad) {
    const std::uint64_t before = mapper->diagnostics().rejected();
    images.write(bad);
    return wait_for([&] { return mapper->diagnostics().rejected() == before + 1; });
  };
  EXPECT_TRUE(rejects(to_message(SyntheticKeyframe(2).make(), kEpoch - 1))) << "an epoch that is over";
  Images bad = to_message(SyntheticKeyframe(3).make());
  bad.map_from_camera().position().x(NAN);
  EXPECT_TRUE(rejects(bad));
  bad = to_message(SyntheticKeyframe(4).make());
  bad.depth().data().resize(10);
  EXPECT_TRUE(rejects(bad));
  bad = to_message(SyntheticKeyframe(5).make());
  bad.camera_info().k()[0] = -1;
  EXPECT_TRUE(rejects(bad));
  Poses strange;
  strange.map_epoch(kEpoch + 7);
  strange.keyframe_ids({1});
  strange.stamps({0});
  strange.poses({0, 0, 0, 0, 0, 0, 1});
  poses.write(strange);  // of an epoch without keyframes: it must not begin one
  Images blind = to_message(SyntheticKeyframe(6).rectangle({0, 0, 320, 240}, NAN).make());
  images.write(blind);
  ASSERT_TRUE(has_revision(2)) << "a keyframe without depth is one";
  {
    const std::lock_guard lock(mutex);
    EXPECT_EQ(info->map_epoch(), kEpoch);
    EXPECT_EQ(info->keyframes_integrated(), 2U);
  }
}

TEST_F(MapperOnTheBus, AnotherTrackersKeyframesAndPosesChangeNothing) {
  start(config());
  send(1);
  ASSERT_TRUE(has_revision(1));
  for (std::uint64_t i = 0; i < 3; ++i) {
    Images strange = to_message(SyntheticKeyframe(i).make(), kEpoch + 1);
    strange.instance(99);
    images.write(strange);
    Poses moved;
    moved.instance(99);
    moved.map_epoch(kEpoch + 1);
    moved.keyframe_ids({1});
    moved.stamps({0});
    moved.poses({9, 9, 9, 0, 0, 0, 1});
    poses.write(moved);
    ASSERT_TRUE(wait_for([&] { return mapper->diagnostics().rejected() == 2 * (i + 1); }));
    send(10 + i);  // the real one goes on
    ASSERT_TRUE(has_revision(2 + i)) << "the map is still that of the tracker that was there first";
  }
  const std::lock_guard lock(mutex);
  EXPECT_EQ(info->map_epoch(), kEpoch);
  EXPECT_EQ(info->keyframes_integrated(), 4U);
  EXPECT_EQ(mapper->figure("rejected rds/keyframe/images: foreign"), "3");
}

TEST_F(MapperOnTheBus, ALoopMovesTheMapOnlyWhenTheTrackerTellsIt) {
  start(config());
  send(1);
  ASSERT_TRUE(has_revision(1));
  const auto correct = [&](std::uint8_t source, double x_m) {
    Poses moved;
    moved.loop_instance(7);
    moved.map_epoch(kEpoch);
    moved.source(source);
    moved.revision(5);
    moved.loop_revision(1);
    moved.keyframe_ids({1});
    moved.stamps({0});
    moved.poses({x_m, 0, 0, 0, 0, 0, 1});
    poses.write(moved);
  };
  correct(messages::kPosesOfLoopCloser, 0.5);  // what the tracker may still refuse
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  {
    const std::lock_guard lock(mutex);
    EXPECT_EQ(info->revision(), 1U);
  }
  correct(messages::kPosesOfTracker, 1.0);
  EXPECT_TRUE(has_revision(2));
}

TEST_F(MapperOnTheBus, ImpossibleBoxesAreLeftOutAndCounted) {
  MapperServiceConfig with_boxes = config();
  with_boxes.expect_boxes = true;
  start(with_boxes);
  geometry::OrientedBox good;
  good.map_from_box.translation() = test::point_at(145, 120, 1.5);
  good.size = {0.5, 0.65, 0.2};
  geometry::OrientedBox huge = good;
  huge.size.x() = 1e30;
  geometry::OrientedBox flat = good;
  flat.size.z() = 0;
  geometry::OrientedBox beside = good;
  beside.map_from_box.translation() = Eigen::Vector3d(50, 0, 1.5);
  const std::vector<messages::SpatialDetection> seen{{"chair", 0.9F, good, ""}, {"chair", 0.9F, huge, ""},
                                                     {"chair", 0.9F, flat, ""}, {"chair", 0.9F, beside, ""},
                                                     {"", 0.9F, good, ""},      {"chair", 7.0F, good, ""}};
  const KeyframeInput input = SyntheticKeyframe(0).make();
  images.write(to_message(input));
  boxes.write(messages::to_detection_message(seen, messages::make_header(input.stamp_ns, "map")));
  ASSERT_TRUE(has_revision(1));
  EXPECT_EQ(mapper->counter("impossible boxes"), 5U);
  const KeyframeInput next = SyntheticKeyframe(1).make();
  vision_msgs::msg::Detection3DArray nonsense =
      messages::to_detection_message(seen, messages::make_header(next.stamp_ns, "map"));
  nonsense.detections()[0].bbox().size().x(-1);
  images.write(to_message(next));
  boxes.write(nonsense);
  EXPECT_TRUE(wait_for([&] { return mapper->diagnostics().rejected() == 1; }));
}

}  // namespace
}  // namespace rds::mapper
