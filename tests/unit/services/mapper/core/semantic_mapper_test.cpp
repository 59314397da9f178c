// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/semantic_mapper.hpp"

#include <gmock/gmock.h>

#include "services/mapper/core/objects/object_json.hpp"
#include "services/mapper/core/octree/tree_bytes.hpp"
#include "tests/unit/services/mapper/core/synthetic_keyframe.hpp"

namespace rds::mapper {
namespace {

using test::is_occupied;
using test::log_odds_at;
using test::occupied_between;
using test::point_at;
using test::SyntheticKeyframe;

const cv::Rect kPerson(120, 40, 80, 200);
constexpr double kPersonM = 1.5;
constexpr double kWallM = 3.0;

SyntheticKeyframe with_person(std::uint64_t id) {
  return SyntheticKeyframe(id).rectangle(kPerson, kPersonM);
}

geometry::Pose shifted(double x, double y, double z) {
  geometry::Pose pose = geometry::Pose::Identity();
  pose.translation() = Eigen::Vector3d(x, y, z);
  return pose;
}

TEST(SemanticMapper, InsertsAStaticSurfaceWithThePapersLogOdds) {
  SemanticMapper mapper(MapperConfig{});
  mapper.integrate(SyntheticKeyframe(0).make());
  EXPECT_FLOAT_EQ(log_odds_at(mapper.map().tree(), point_at(20, 20, kWallM)), 0.85F);
  mapper.integrate(SyntheticKeyframe(1).make());
  EXPECT_FLOAT_EQ(log_odds_at(mapper.map().tree(), point_at(20, 20, kWallM)), 1.7F);
  for (std::uint64_t id = 2; id < 8; ++id) mapper.integrate(SyntheticKeyframe(id).make());
  EXPECT_NEAR(log_odds_at(mapper.map().tree(), point_at(20, 20, kWallM)), std::log(0.97 / 0.03), 1e-4);
}

TEST(SemanticMapper, NeverInsertsAMovableObjectAndKeepsTheWallBesideIt) {
  SemanticMapper mapper(MapperConfig{});
  mapper.integrate(with_person(0).box("person", kPerson, true).make());
  EXPECT_EQ(occupied_between(mapper.map().tree(), 0, 2.5), 0);
  EXPECT_FLOAT_EQ(log_odds_at(mapper.map().tree(), point_at(160, 120, kPersonM)), -0.41F);
  EXPECT_TRUE(is_occupied(mapper.map().tree(), point_at(20, 120, kWallM)));
}

TEST(SemanticMapper, KeepsTheTableBehindAPersonInsideHisBox) {
  const cv::Rect wide(60, 20, 200, 220);  // a box much larger than the person: the wall shows in it
  SemanticMapper mapper(MapperConfig{});
  auto keyframe = with_person(0).make();
  keyframe.boxes.emplace().push_back({"person", 0.9F, {60, 20, 260, 240}, std::nullopt, 1.5F, true});
  mapper.integrate(keyframe);
  EXPECT_TRUE(is_occupied(mapper.map().tree(), point_at(75, 120, kWallM)));
  EXPECT_TRUE(is_occupied(mapper.map().tree(), point_at(245, 120, kWallM)));
  EXPECT_EQ(occupied_between(mapper.map().tree(), 0, 2.5), 0);
}

TEST(SemanticMapper, APersonInsertedBeforeHisDetectionVanishesAtTheNextMovableSightings) {
  MapperConfig config;
  config.octree.carve_rays = false;  // the paper's rule alone
  SemanticMapper mapper(config);
  mapper.integrate(with_person(0).looked_for_objects().make());
  EXPECT_TRUE(is_occupied(mapper.map().tree(), point_at(160, 120, kPersonM)));
  for (std::uint64_t id = 1; id < 4; ++id)
    mapper.integrate(with_person(id).box("person", kPerson, true).make());
  EXPECT_EQ(occupied_between(mapper.map().tree(), 1.6, 2.5), 0);
  EXPECT_FALSE(is_occupied(mapper.map().tree(), point_at(160, 120, kPersonM)));
}

TEST(SemanticMapper, RaysToTheBackgroundCarveAwayWhoStoodThere) {
  SemanticMapper mapper(MapperConfig{});
  mapper.integrate(with_person(0).make());
  EXPECT_GT(occupied_between(mapper.map().tree(), 1.4, 1.6), 100);
  for (std::uint64_t id = 1; id < 4; ++id) mapper.integrate(SyntheticKeyframe(id).make());
  EXPECT_EQ(occupied_between(mapper.map().tree(), 1.4, 1.6), 0);
}

TEST(SemanticMapper, RaysBeyondTheRangeCarveToo) {
  SemanticMapper mapper(MapperConfig{});
  mapper.integrate(with_person(0).make());
  for (std::uint64_t id = 1; id < 4; ++id) mapper.integrate(SyntheticKeyframe(id, 5.5).make());
  EXPECT_EQ(occupied_between(mapper.map().tree(), 0, 10), 0);
}

TEST(SemanticMapper, WhoStoodBeforeNothingMeasurableIsGoneThreeKeyframesAfterLeaving) {
  constexpr double kNothing = 0;
  SemanticMapper mapper(MapperConfig{});
  const auto person = test::point_at(160, 120, 1.5);
  mapper.integrate(SyntheticKeyframe(0, kNothing).rectangle({120, 40, 80, 160}, 1.5));
  EXPECT_TRUE(is_occupied(mapper.map().tree(), person));
  for (std::uint64_t id = 1; id <= 3; ++id) mapper.integrate(SyntheticKeyframe(id, kNothing));
  EXPECT_EQ(occupied_between(mapper.map().tree(), 0, 4), 0);
  const auto beside = test::point_at(40, 120, 1.0);
  EXPECT_TRUE(std::isnan(log_odds_at(mapper.map().tree(), beside)));  // free is only what a ray measured
}

TEST(SemanticMapper, ADarkSurfaceThatIsSeenNowAndThenStays) {
  constexpr double kNothing = 0;
  SemanticMapper mapper(MapperConfig{});
  for (std::uint64_t id = 0; id < 3; ++id)
    mapper.integrate(SyntheticKeyframe(id, kNothing).rectangle(kPerson, 1.5));
  for (std::uint64_t id = 3; id < 20; ++id) mapper.integrate(SyntheticKeyframe(id, kNothing));
  EXPECT_TRUE(is_occupied(mapper.map().tree(), test::point_at(160, 120, 1.5)));
}

TEST(SemanticMapper, AVoxelChangesOncePerKeyframe) {
  SemanticMapper mapper(MapperConfig{});
  const auto delta = mapper.integrate(SyntheticKeyframe(0).make());
  std::set<std::array<std::uint16_t, 3>> keys;
  for (std::size_t i = 0; i < delta.log_odds.size(); ++i) {
    EXPECT_TRUE(keys.insert({delta.keys[3 * i], delta.keys[3 * i + 1], delta.keys[3 * i + 2]}).second);
    EXPECT_TRUE(delta.log_odds[i] == 0.85F || delta.log_odds[i] == -0.41F) << delta.log_odds[i];
  }
}

TEST(SemanticMapper, PixelsWithoutUsableDepthLeaveNoTrace) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const double depth : {0.0, double{nan}, -1.0, double{std::numeric_limits<float>::infinity()}, 0.2}) {
    SemanticMapper mapper(MapperConfig{});
    const auto delta = mapper.integrate(SyntheticKeyframe(0, depth).make());
    EXPECT_TRUE(delta.keys.empty()) << depth;
    EXPECT_EQ(mapper.map().tree().size(), 0U) << depth;
  }
}

TEST(SemanticMapper, FlyingPixelsAtADepthEdgeAreRejected) {
  auto keyframe =
      SyntheticKeyframe(0).rectangle({160, 0, 160, 240}, 1.5).rectangle({158, 0, 2, 240}, 2.2).make();
  SemanticMapper mapper(MapperConfig{});
  mapper.integrate(keyframe);
  EXPECT_EQ(occupied_between(mapper.map().tree(), 1.8, 2.7), 0);
  EXPECT_GT(occupied_between(mapper.map().tree(), 1.4, 1.6), 0);
}

TEST(SemanticMapper, SurvivesBoxesThatMakeNoSense) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  auto keyframe = SyntheticKeyframe(0).looked_for_objects().make();
  const geometry::Box3 far{Eigen::Vector3d::Constant(1e6), Eigen::Vector3d::Constant(2e6)};
  const geometry::Box3 not_finite{Eigen::Vector3d::Constant(nan), Eigen::Vector3d::Constant(nan)};
  for (const bool movable : {false, true}) {
    for (const auto& b : {geometry::Box2{1000, 1000, 2000, 2000}, geometry::Box2{50, 50, 10, 10},
                          geometry::Box2{nan, 0, 50, 50}, geometry::Box2{-1e9, -1e9, 1e9, 1e9}})
      keyframe.boxes->push_back({"chair", 0.5F, b, std::nullopt, 0, movable});
    keyframe.boxes->push_back({"chair", std::numeric_limits<float>::quiet_NaN(), {}, far, -5.0F, movable});
    keyframe.boxes->push_back({"", 0.5F, {}, not_finite, 0, movable});
    keyframe.boxes->push_back(
        {"chair", 0.5F, {0, 0, 320, 240}, std::nullopt, static_cast<float>(nan), movable});
  }
  SemanticMapper mapper(MapperConfig{});
  EXPECT_NO_THROW(mapper.integrate(keyframe));
}

TEST(SemanticMapper, NamesWhatIsWrongWithAKeyframe) {
  const auto fault = [](auto spoil) {
    auto keyframe = SyntheticKeyframe(7).make();
    spoil(keyframe);
    return check(keyframe).value_or("");
  };
  EXPECT_EQ(fault([](KeyframeInput&) {}), "");
  EXPECT_THAT(fault([](auto& k) { k.map_from_camera.translation().x() = NAN; }),
              testing::HasSubstr("keyframe 7: the pose"));
  EXPECT_THAT(fault([](auto& k) { k.depth.values = cv::Mat(10, 10, CV_16UC1); }),
              testing::HasSubstr("depth picture of 320×240"));
  EXPECT_THAT(fault([](auto& k) { k.color.pixels = cv::Mat(); }),
              testing::HasSubstr("colour picture of 320×240"));
  EXPECT_THAT(fault([](auto& k) { k.movable_cells = cv::Mat1b(60, 81, std::uint8_t{0}); }),
              testing::HasSubstr("cells that cover a picture of 320×240"));
  EXPECT_THAT(fault([](auto& k) { k.camera.fx = 0; }), testing::HasSubstr("camera model"));
  SemanticMapper mapper(MapperConfig{});
  mapper.integrate(SyntheticKeyframe(7).make());
  EXPECT_THROW(mapper.integrate(SyntheticKeyframe(7).make()), std::invalid_argument);
}

TEST(SemanticMapper, LabelsTheVoxelsOfAStaticObjectAndColoursThem) {
  const cv::Rect chair(100, 80, 90, 90);
  SemanticMapper mapper(MapperConfig{});
  for (std::uint64_t id = 0; id < 2; ++id)
    mapper.integrate(SyntheticKeyframe(id).rectangle(chair, 2.0).box("chair", chair, false).make());
  const auto& tree = mapper.map().tree();
  const auto on_chair = point_at(145, 125, 2.0);
  const auto key = tree.coordToKey(on_chair.x(), on_chair.y(), on_chair.z());
  EXPECT_EQ(mapper.map().labels.names().at(mapper.map().label(key)), "chair");
  const Rgb expected = label_color("chair");
  const auto color = tree.search(key)->getColor();
  EXPECT_EQ((Rgb{color.r, color.g, color.b}), expected);
  const auto on_wall = point_at(20, 20, kWallM);
  EXPECT_EQ(mapper.map().label(tree.coordToKey(on_wall.x(), on_wall.y(), on_wall.z())), 0);
  const auto wall_color = tree.search(on_wall.x(), on_wall.y(), on_wall.z())->getColor();
  EXPECT_EQ((Rgb{wall_color.r, wall_color.g, wall_color.b}), (Rgb{110, 100, 90}));
}

TEST(SemanticMapper, FollowsPoseCorrectionsAsIfItHadKnownThemAllAlong) {
  SemanticMapper live(MapperConfig{}, 5);
  SemanticMapper known(MapperConfig{}, 5);
  std::vector<KeyframePose> corrected;
  for (std::uint64_t id = 0; id < 4; ++id) {
    auto keyframe = with_person(id).box("person", kPerson, true).box("sofa", {10, 150, 80, 60}, false).make();
    keyframe.map_from_camera = shifted(0.1 * static_cast<double>(id), 0, 0);
    live.integrate(keyframe);
    keyframe.map_from_camera = shifted(0.13 * static_cast<double>(id), 0.02, 0.01);
    known.integrate(keyframe);
    corrected.push_back({id, keyframe.stamp_ns, keyframe.map_from_camera});
  }
  const auto delta = live.apply_poses(corrected);
  EXPECT_FALSE(delta.is_noop());
  EXPECT_FALSE(delta.deleted_keys.empty());
  EXPECT_EQ(to_bytes(live.map().tree()), to_bytes(known.map().tree()));
  EXPECT_EQ(to_json(live.map().objects()), to_json(known.map().objects()));
}

/// A corridor that a robot went along, and its corrected poses.
struct Corridor {
  static constexpr std::size_t kKeyframes = 3 * SemanticMapper::kMovedAtOnce;

  explicit Corridor(double step_m) {
    config.octree.resolution_m = 0.1;
    config.sampling.stride_px = 4;
    for (std::uint64_t id = 0; id < kKeyframes; ++id) keyframes.push_back(keyframe(id, step_m));
  }
  static KeyframeInput keyframe(std::uint64_t id, double step_m) {
    return SyntheticKeyframe(id).pose(shifted(step_m * static_cast<double>(id), 0, 0));
  }
  [[nodiscard]] std::vector<KeyframePose> poses() const {
    std::vector<KeyframePose> poses;
    for (const auto& k : keyframes) poses.push_back({k.id, k.stamp_ns, k.map_from_camera});
    return poses;
  }
  MapperConfig config;
  std::vector<KeyframeInput> keyframes;
};

TEST(SemanticMapper, ALargeCorrectionTakesSeveralStepsAndEndsAsIfItHadBeenKnownAllAlong) {
  const Corridor before(0.1);
  const Corridor after(0.13);
  SemanticMapper live(before.config, 5);
  SemanticMapper known(before.config, 5);
  for (const auto& keyframe : before.keyframes) live.integrate(keyframe);
  for (const auto& keyframe : after.keyframes) known.integrate(keyframe);
  EXPECT_FALSE(live.is_correcting());
  int steps = 1;
  for (live.apply_poses(after.poses()); live.is_correcting(); ++steps) {
    if (steps == 2) {  // deltas go on meanwhile
      const auto next = Corridor::keyframe(Corridor::kKeyframes, 0.13);
      EXPECT_FALSE(live.integrate(next).keys.empty());
      known.integrate(next);
    }
    EXPECT_FALSE(live.go_on_correcting().is_noop());
  }
  EXPECT_EQ(steps, 3);
  EXPECT_TRUE(live.go_on_correcting().is_noop());
  EXPECT_EQ(to_bytes(live.map().tree()), to_bytes(known.map().tree()));
}

TEST(SemanticMapper, WhatIsNearTheNewestKeyframeIsCorrectedFirst) {
  const Corridor before(0.1);
  const Corridor after(0.13);
  SemanticMapper mapper(before.config);
  for (const auto& keyframe : before.keyframes) mapper.integrate(keyframe);
  mapper.apply_poses(after.poses());
  for (const auto& [id, keyframe] : mapper.archive().keyframes())
    EXPECT_EQ(keyframe.integrated_pose.isApprox(keyframe.pose),
              id == 0 || id >= Corridor::kKeyframes - SemanticMapper::kMovedAtOnce)
        << id;
}

TEST(SemanticMapper, SettlesALargeCorrectionAtOnce) {
  const Corridor before(0.1);
  const Corridor after(0.13);
  SemanticMapper mapper(before.config);
  SemanticMapper known(before.config);
  for (const auto& keyframe : before.keyframes) mapper.integrate(keyframe);
  for (const auto& keyframe : after.keyframes) known.integrate(keyframe);
  mapper.apply_poses(after.poses());
  mapper.settle({});
  EXPECT_FALSE(mapper.is_correcting());
  EXPECT_EQ(to_bytes(mapper.map().tree()), to_bytes(known.map().tree()));
}

TEST(SemanticMapper, SmallCorrectionsWaitForSettle) {
  SemanticMapper mapper(MapperConfig{});
  mapper.integrate(SyntheticKeyframe(0).make());
  const auto before = to_bytes(mapper.map().tree());
  const std::vector<KeyframePose> poses{{0, 0, shifted(0, 0, 0.008)}};
  EXPECT_TRUE(mapper.apply_poses(poses).is_noop());
  EXPECT_EQ(to_bytes(mapper.map().tree()), before);
  EXPECT_FALSE(mapper.settle(poses).is_noop());
  SemanticMapper scratch(MapperConfig{});
  scratch.integrate(SyntheticKeyframe(0).pose(shifted(0, 0, 0.008)).make());
  EXPECT_EQ(to_bytes(mapper.map().tree()), to_bytes(scratch.map().tree()));
}

TEST(SemanticMapper, SettlesToTheSameBytesWhateverTheOrderOfArrival) {
  const auto keyframe = [](std::uint64_t id) {
    return with_person(id).pose(shifted(0.05 * static_cast<double>(id), 0, 0)).make();
  };
  const std::vector<LabelledBox> boxes = *with_person(0).box("person", kPerson, true).make().boxes;
  SemanticMapper in_order(MapperConfig{});
  SemanticMapper disordered(MapperConfig{});
  for (const std::uint64_t id : {0U, 1U, 2U}) {
    auto complete = keyframe(id);
    complete.boxes = boxes;
    in_order.integrate(complete);
  }
  for (const std::uint64_t id : {2U, 0U, 1U}) disordered.integrate(keyframe(id));
  EXPECT_NE(to_bytes(disordered.map().tree()), to_bytes(in_order.map().tree()));
  for (const std::uint64_t id : {1U, 2U, 0U}) EXPECT_TRUE(disordered.set_boxes(id, boxes));
  EXPECT_FALSE(disordered.set_boxes(99, boxes));
  disordered.settle({});
  EXPECT_EQ(to_bytes(disordered.map().tree()), to_bytes(in_order.map().tree()));
}

TEST(SemanticMapper, IgnoresPosesThatAreNotFiniteOrOfUnknownKeyframes) {
  SemanticMapper mapper(MapperConfig{});
  mapper.integrate(SyntheticKeyframe(0).make());
  const std::vector<KeyframePose> poses{{0, 0, shifted(NAN, 0, 0)}, {17, 0, shifted(1, 0, 0)}};
  EXPECT_TRUE(mapper.apply_poses(poses).is_noop());
}

TEST(SemanticMapper, KeyframesBeyondTheLimitBecomeFinalAndStayInTheMap) {
  MapperConfig config;
  config.correction.max_keyframes = 2;
  SemanticMapper limited(config);
  SemanticMapper unlimited(MapperConfig{});
  for (std::uint64_t id = 0; id < 5; ++id) {
    const auto keyframe = SyntheticKeyframe(id).pose(shifted(0.1 * static_cast<double>(id), 0, 0)).make();
    limited.integrate(keyframe);
    unlimited.integrate(keyframe);
  }
  limited.settle({});
  EXPECT_EQ(limited.archive().size(), 5U);
  EXPECT_EQ(limited.archive().poses().size(), 2U);
  EXPECT_EQ(to_bytes(limited.map().tree()), to_bytes(unlimited.map().tree()));
  EXPECT_FALSE(limited.set_boxes(0, {}));
}

TEST(SemanticMapper, KeyframesThatNobodyTellsOfBecomeFinalAndStayInTheMap) {
  SemanticMapper mapper(MapperConfig{});
  SemanticMapper all(MapperConfig{});
  for (std::uint64_t id = 0; id < 5; ++id) {
    const auto keyframe = SyntheticKeyframe(id).pose(shifted(0.1 * static_cast<double>(id), 0, 0)).make();
    mapper.integrate(keyframe);
    all.integrate(keyframe);
  }
  const std::vector<KeyframePose> told{{0, 0, shifted(0, 0, 0)}, {3, 0, shifted(0.3, 0, 0)}};
  mapper.make_others_final(told);  // 1 and 2; 4 is newer than what was told
  mapper.settle({});
  EXPECT_EQ(mapper.archive().size(), 5U);
  EXPECT_EQ(mapper.archive().poses().size(), 3U);
  EXPECT_EQ(to_bytes(mapper.map().tree()), to_bytes(all.map().tree()));
  mapper.make_others_final({});
  EXPECT_EQ(mapper.archive().poses().size(), 3U);
}

TEST(SemanticMapper, KeyframesFarOutsideTheOctreeAreHarmless) {
  SemanticMapper mapper(MapperConfig{});
  EXPECT_NO_THROW(mapper.integrate(SyntheticKeyframe(0).pose(shifted(1e7, 0, 0)).make()));
  EXPECT_NO_THROW(mapper.integrate(SyntheticKeyframe(1).pose(shifted(0, 1638, 0)).make()));
}

}  // namespace
}  // namespace rds::mapper
