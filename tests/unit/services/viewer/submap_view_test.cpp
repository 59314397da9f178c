// SPDX-License-Identifier: Apache-2.0
#include "services/viewer/submap_view.hpp"

#include <gmock/gmock.h>

namespace rds::viewer {
namespace {

using geometry::KeyframePose;
using testing::ElementsAre;

KeyframePose keyframe(std::uint64_t id, double x) {
  KeyframePose pose;
  pose.id = id;
  pose.map_from_camera = Eigen::Translation3d(x, 0, 0);
  return pose;
}

void tell(SubmapView& view, std::uint64_t base, std::uint64_t revision, std::vector<KeyframePose> poses) {
  rds_msgs::msg::KeyFramePoses message;
  message.base_revision(base);
  message.revision(revision);
  view.take(message, poses);
}

std::vector<std::uint64_t> ids(const SubmapView& view) {
  std::vector<std::uint64_t> ids;
  for (const auto& keyframe : view.keyframes()) ids.push_back(keyframe.id);
  return ids;
}

TEST(SubmapView, HasTheKeyframesOfTheSubmapWhereTheCameraIs) {
  SubmapView view;
  EXPECT_FALSE(view.leave());
  tell(view, 0, 1, {keyframe(5, 0), keyframe(6, 1)});
  EXPECT_THAT(ids(view), ElementsAre(5, 6));
  EXPECT_TRUE(view.leave());
  EXPECT_THAT(ids(view), ElementsAre());
  EXPECT_FALSE(view.leave());
  tell(view, 1, 2, {keyframe(9, 0)});  // the next one, told as what is new
  EXPECT_THAT(ids(view), ElementsAre(9));
}

TEST(SubmapView, PlacesTheCameraByItsReferenceKeyframe) {
  SubmapView view;
  tell(view, 0, 1, {keyframe(5, 2)});
  rds_msgs::msg::TrackingState state;
  state.reference_keyframe_id(5);
  state.reference_from_camera().orientation().w(1);
  state.reference_from_camera().position().x(0.5);
  ASSERT_TRUE(view.camera(state));
  EXPECT_DOUBLE_EQ(view.camera(state)->translation().x(), 2.5);
  state.reference_keyframe_id(6);
  EXPECT_FALSE(view.camera(state));
}

}  // namespace
}  // namespace rds::viewer
