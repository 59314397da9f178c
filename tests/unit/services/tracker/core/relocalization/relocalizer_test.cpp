// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/relocalization/relocalizer.hpp"

#include <gtest/gtest.h>

#include "services/tracker/core/motion/se3.hpp"
#include "tests/unit/services/tracker/core/known_place.hpp"

namespace rds::tracker {
namespace {

const auto anywhere = [](const Keyframe&) { return true; };

class Relocalization : public testing::Test, protected test::KnownPlace {
 protected:
  Relocalization() {
    add_keyframe(Pose::Identity());
    add_keyframe(test::pose(0.3, 0, 0, -0.1));
  }

  /// A frame from there of which nothing is known yet.
  TrackedFrame unknown_frame() {
    TrackedFrame frame = frame_at(place);
    frame.clear_matches();
    frame.camera_from_map = Pose::Identity();
    return frame;
  }

  Pose place = test::pose(0.15, 0.05, -0.1, 0.1);
  Relocalizer relocalizer;
};

TEST_F(Relocalization, FindsTheCameraInAKnownPlace) {
  relocalizer.index_all(map);
  ASSERT_EQ(relocalizer.places(), 2U);
  TrackedFrame frame = unknown_frame();
  ASSERT_TRUE(relocalizer.localize(context(), anywhere, frame));
  EXPECT_LT(se3_log(frame.camera_from_map * place).norm(), 1e-4);
  EXPECT_GT(frame.static_matches(), Relocalizer::kMinInliers);
}

TEST_F(Relocalization, LooksAroundAPlaceAndNowhereElse) {
  relocalizer.index_all(map);
  SoughtPlace around{test::pose(0.4, 0.3, 0), 1, 0.8};
  TrackedFrame frame = unknown_frame();
  const auto is_there = [&](const Keyframe& k) { return around.contains(k.map_from_camera); };
  ASSERT_TRUE(relocalizer.localize(context(), is_there, frame));
  EXPECT_LT(se3_log(frame.camera_from_map * place).norm(), 1e-4);
  around.map_from_camera.translation().x() = 5;
  frame = unknown_frame();
  EXPECT_FALSE(relocalizer.localize(context(), is_there, frame));
}

TEST(SoughtPlace, CountsOverTheGroundAndByTheWayThatTheCameraLooks) {
  const auto camera = [](double x, double z, double heading_rad, double tilt_rad) {
    Eigen::Matrix3d ahead;  // optical axis along x, z up
    ahead << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    const Eigen::AngleAxisd heading(heading_rad, Eigen::Vector3d::UnitZ());
    const Eigen::AngleAxisd tilt(tilt_rad, Eigen::Vector3d::UnitX());
    return geometry::make_pose({x, 0, z}, Eigen::Quaterniond(heading * Eigen::Quaterniond(ahead) * tilt));
  };
  const SoughtPlace place{camera(1, 0, 0, 0), 1, 0.8};
  EXPECT_TRUE(place.contains(camera(1.9, 3, 0.7, 0.4))) << "how high it stands is not known";
  EXPECT_FALSE(place.contains(camera(2.1, 0, 0, 0)));
  EXPECT_FALSE(place.contains(camera(1, 0, 0.9, 0)));
  EXPECT_TRUE(place.contains(camera(1, 0, 3, -1.5))) << "it looks down: its heading tells nothing";
}

TEST_F(Relocalization, DoesNotFindItWhereNoKeyframeIsKnown) {
  TrackedFrame frame = unknown_frame();
  EXPECT_FALSE(relocalizer.localize(context(), anywhere, frame));
  relocalizer.add(0);
  EXPECT_EQ(relocalizer.places(), 1U) << "it counts at once, and is found by after index_pending()";
  EXPECT_FALSE(relocalizer.localize(context(), anywhere, frame));
  relocalizer.index_pending(map);
  EXPECT_TRUE(relocalizer.localize(context(), anywhere, frame));
  relocalizer.remove(0);
  EXPECT_EQ(relocalizer.places(), 0U);
}

TEST_F(Relocalization, DoesNotFindItInAnotherPlace) {
  relocalizer.index_all(map);
  TrackedFrame frame = unknown_frame();
  std::vector<Feature> features = frame.features->all();
  for (Feature& f : features)
    for (auto& byte : f.descriptor) byte = static_cast<std::uint8_t>(random());
  frame.features = std::make_shared<const FeatureSet>(test::small_camera(), std::move(features));
  EXPECT_FALSE(relocalizer.localize(context(), anywhere, frame));
}

TEST_F(Relocalization, FeaturesOnMovableObjectsAreNoPlace) {
  std::vector<Feature> features = frame_at(place).features->all();
  const auto count = static_cast<int>(features.size());
  features.front().movable = true;
  EXPECT_EQ(static_descriptors(FeatureSet(test::small_camera(), features)).rows, count - 1);
}

}  // namespace
}  // namespace rds::tracker
