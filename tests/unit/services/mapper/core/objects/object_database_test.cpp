// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/objects/object_database.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "services/mapper/core/objects/object_json.hpp"
#include "tests/unit/services/mapper/core/synthetic_keyframe.hpp"

namespace rds::mapper {
namespace {

using test::point_at;
using test::SyntheticKeyframe;

const cv::Rect kChair(100, 80, 80, 80);
constexpr double kChairM = 2.0;

SyntheticKeyframe with_chair(std::uint64_t id, float score = 0.8F) {
  return SyntheticKeyframe(id).rectangle(kChair, kChairM).box("chair", kChair, false, score);
}

TEST(ObjectDatabase, FusesSightingsOfTheSameObjectIntoOne) {
  SemanticMapper mapper(MapperConfig{});
  for (std::uint64_t id = 0; id < 5; ++id) mapper.integrate(with_chair(id).make());
  const auto objects = mapper.map().objects();
  ASSERT_EQ(objects.size(), 1U);
  EXPECT_EQ(objects[0].label, "chair");
  EXPECT_EQ(objects[0].observations, 5U);
  EXPECT_NEAR(objects[0].score, 0.8, 1e-6);
  EXPECT_LT((objects[0].center - point_at(140, 120, kChairM)).norm(), 0.05);
  EXPECT_NEAR(objects[0].size.x(), 80 * kChairM / 290, 0.08);
  EXPECT_EQ(objects[0].first_seen_ns, 0);
  EXPECT_EQ(objects[0].last_seen_ns, 400'000'000);
}

TEST(ObjectDatabase, ReportsAnObjectOnlyAfterEnoughSightings) {
  SemanticMapper mapper(MapperConfig{});
  mapper.integrate(with_chair(0).make());
  EXPECT_TRUE(mapper.map().objects().empty());
  mapper.integrate(with_chair(1).make());
  EXPECT_EQ(mapper.map().objects().size(), 1U);
}

TEST(ObjectDatabase, ReportsAnObjectOfWeakBoxesAfterMoreSightings) {
  SemanticMapper mapper(MapperConfig{});
  for (std::uint64_t id = 0; id < 3; ++id) mapper.integrate(with_chair(id, 0.3F));
  EXPECT_TRUE(mapper.map().objects().empty());
  mapper.integrate(with_chair(3, 0.3F));
  EXPECT_EQ(mapper.map().objects().size(), 1U);
}

TEST(ObjectDatabase, KeepsNeighboursOfTheSameClassApart) {
  const cv::Rect left(20, 80, 60, 60);
  const cv::Rect right(230, 80, 60, 60);
  SemanticMapper mapper(MapperConfig{});
  for (std::uint64_t id = 0; id < 3; ++id)
    mapper.integrate(SyntheticKeyframe(id)
                         .rectangle(left, 2.0)
                         .rectangle(right, 2.0)
                         .box("chair", left, false)
                         .box("chair", right, false)
                         .make());
  EXPECT_EQ(mapper.map().objects().size(), 2U);
}

TEST(ObjectDatabase, ASightingWhoseMiddleLiesInAnObjectIsOfIt) {
  const cv::Rect table(0, 80, 240, 80);
  const cv::Rect end_and_more(170, 60, 130, 140);
  SemanticMapper mapper(MapperConfig{});
  std::uint64_t id = 0;
  for (; id < 3; ++id)
    mapper.integrate(SyntheticKeyframe(id).rectangle(table, 2.0).box("diningtable", table, false));
  for (; id < 5; ++id)
    mapper.integrate(
        SyntheticKeyframe(id).rectangle(end_and_more, 2.0).box("diningtable", end_and_more, false));
  EXPECT_EQ(mapper.map().objects().size(), 1U);
}

TEST(ObjectDatabase, KeepsWithItsLabelsWhatTheDetectorSeldomFinds) {
  SemanticMapper mapper(MapperConfig{});
  std::uint64_t id = 0;
  for (; id < 2; ++id) mapper.integrate(with_chair(id));
  for (; id < 25; ++id)
    mapper.integrate(SyntheticKeyframe(id).rectangle(kChair, kChairM).looked_for_objects());
  EXPECT_EQ(mapper.map().objects().size(), 1U);
  const auto middle = point_at(140, 120, kChairM);
  const auto color = mapper.map().tree().search(middle.x(), middle.y(), middle.z())->getColor();
  EXPECT_EQ((Rgb{color.r, color.g, color.b}), label_color("chair"));
}

TEST(ObjectDatabase, WhatIsFoundLateHasItsLabelAtOnce) {
  SemanticMapper mapper(MapperConfig{});
  std::uint64_t id = 0;
  for (; id < 20; ++id)
    mapper.integrate(SyntheticKeyframe(id).rectangle(kChair, kChairM).looked_for_objects());
  for (; id < 24; ++id) mapper.integrate(with_chair(id));
  const auto middle = point_at(140, 120, kChairM);
  const auto color = [&] {
    const auto c = mapper.map().tree().search(middle.x(), middle.y(), middle.z())->getColor();
    return Rgb{c.r, c.g, c.b};
  };
  EXPECT_EQ(color(), label_color("chair"));
}

TEST(ObjectDatabase, ForgetsWhatWasFoundTwiceAndThenNeverAgain) {
  SemanticMapper mapper(MapperConfig{});
  std::uint64_t id = 0;
  for (; id < 2; ++id) mapper.integrate(with_chair(id));
  for (; id < 60; ++id)
    mapper.integrate(SyntheticKeyframe(id).rectangle(kChair, kChairM).looked_for_objects());
  EXPECT_TRUE(mapper.map().objects().empty());
  for (; id < 80; ++id)
    mapper.integrate(SyntheticKeyframe(id).rectangle(kChair, kChairM).looked_for_objects());
  const auto middle = point_at(140, 120, kChairM);
  const auto color = mapper.map().tree().search(middle.x(), middle.y(), middle.z())->getColor();
  EXPECT_NE((Rgb{color.r, color.g, color.b}), label_color("chair"));
}

TEST(ObjectDatabase, AWrongFirstLabelHeals) {
  SemanticMapper mapper(MapperConfig{});
  std::uint64_t id = 0;
  for (; id < 3; ++id)
    mapper.integrate(SyntheticKeyframe(id).rectangle(kChair, kChairM).box("sofa", kChair, false));
  ASSERT_EQ(mapper.map().objects().size(), 1U);
  EXPECT_EQ(mapper.map().objects()[0].label, "sofa");
  for (; id < 8; ++id) mapper.integrate(with_chair(id, 0.9F));
  const auto objects = mapper.map().objects();
  ASSERT_EQ(objects.size(), 1U) << to_json(objects);
  EXPECT_EQ(objects[0].id, 1U);
  EXPECT_EQ(objects[0].label, "chair");
  EXPECT_EQ(objects[0].observations, 8U);
  ASSERT_EQ(objects[0].labels.size(), 2U);
  EXPECT_EQ(objects[0].labels[0].label, "chair");
  EXPECT_EQ(objects[0].labels[1].label, "sofa");
  EXPECT_GT(objects[0].labels[0].probability, 0.9);
  EXPECT_NEAR(objects[0].size.x(), 80 * kChairM / 290, 0.08)
      << "its voxels are all of them, whoever named them";
}

TEST(ObjectDatabase, TwoKindsOfThingInOnePlaceThatGrewTogetherAreOne) {
  SemanticMapper mapper(MapperConfig{});
  const cv::Rect part(100, 80, 80, 30);
  std::uint64_t id = 0;
  for (; id < 3; ++id)  // the upper part is seen as one thing, the whole as another one
    mapper.integrate(SyntheticKeyframe(id).rectangle(kChair, kChairM).box("sofa", part, false, 0.8F));
  for (; id < 6; ++id) mapper.integrate(with_chair(id, 0.9F));
  EXPECT_EQ(mapper.map().objects().size(), 2U) << "a third of its room may be another thing";
  for (; id < 14; ++id)
    mapper.integrate(SyntheticKeyframe(id).rectangle(kChair, kChairM).box("sofa", kChair, false, 0.5F));
  const auto objects = mapper.map().objects();
  ASSERT_EQ(objects.size(), 1U) << to_json(objects);
  EXPECT_EQ(objects[0].id, 1U);
}

TEST(ObjectDatabase, ASmallThingBeforeALargeOneStaysItself) {
  const cv::Rect bottle(130, 60, 16, 50);
  SemanticMapper mapper(MapperConfig{});
  for (std::uint64_t id = 0; id < 6; ++id)
    mapper.integrate(SyntheticKeyframe(id)
                         .rectangle(kChair, kChairM)
                         .rectangle(bottle, kChairM - 0.1)
                         .box("chair", kChair, false)
                         .box("bottle", bottle, false));
  EXPECT_EQ(mapper.map().objects().size(), 2U);
}

TEST(ObjectDatabase, MovableObjectsNeverEnter) {
  SemanticMapper mapper(MapperConfig{});
  for (std::uint64_t id = 0; id < 4; ++id)
    mapper.integrate(SyntheticKeyframe(id).rectangle(kChair, kChairM).box("person", kChair, true).make());
  EXPECT_TRUE(mapper.map().objects().empty());
}

/// A chair that stood for ten minutes, and then not.
struct CarriedAway {
  CarriedAway() {
    for (; next < 40; ++next) see(with_chair(150 * next));  // keyframe ids are tenths of a second
  }
  void see(const KeyframeInput& keyframe) { mapper.integrate(keyframe); }
  void see_through(int times) {
    for (int i = 0; i < times; ++i, ++next) see(SyntheticKeyframe(150 * next).looked_for_objects());
  }
  [[nodiscard]] MapObject chair() const {
    const auto objects = mapper.map().objects();
    EXPECT_EQ(objects.size(), 1U);
    return objects.empty() ? MapObject{} : objects.front();
  }
  SemanticMapper mapper{MapperConfig{}};
  std::uint64_t next = 0;
};

TEST(ObjectDatabase, WhatIsSeenThroughInFiveKeyframesHasGoneAndIsStillListed) {
  CarriedAway chair;
  EXPECT_FALSE(chair.chair().has_gone);
  chair.see_through(4);
  EXPECT_FALSE(chair.chair().has_gone);
  chair.see_through(1);
  EXPECT_TRUE(chair.chair().has_gone);
  chair.see_through(20);
  EXPECT_TRUE(chair.chair().has_gone);
  EXPECT_EQ(chair.chair().label, "chair");
  EXPECT_EQ(chair.chair().first_seen_ns, 0);
  EXPECT_EQ(chair.chair().last_seen_ns, 39 * 15'000'000'000);
}

TEST(ObjectDatabase, WhatIsBackHasItsIdAndItsPlace) {
  CarriedAway chair;
  chair.see_through(20);
  const cv::Rect beside = kChair + cv::Point(40, 0);  // 28 cm
  for (int i = 0; i < 3; ++i, ++chair.next)
    chair.see(SyntheticKeyframe(150 * chair.next).rectangle(beside, kChairM).box("chair", beside, false));
  EXPECT_FALSE(chair.chair().has_gone);
  EXPECT_EQ(chair.chair().id, 1U);
  EXPECT_EQ(chair.chair().first_seen_ns, 0);
  EXPECT_LT((chair.chair().center - point_at(180, 120, kChairM)).norm(), 0.05);
}

TEST(ObjectDatabase, WhatHasGoneOutlastsItsBytes) {
  CarriedAway chair;
  chair.see_through(20);
  SemanticMapper restored{MapperConfig{}};
  ASSERT_TRUE(test::start_from(restored, test::saved_bytes(chair.mapper)));
  ASSERT_EQ(restored.map().objects().size(), 1U);
  EXPECT_TRUE(restored.map().objects().front().has_gone);
}

TEST(ObjectDatabase, KeepsWhatIsHiddenOrOutOfViewOrNotLookedFor) {
  SemanticMapper mapper(MapperConfig{});
  std::uint64_t id = 0;
  for (; id < 3; ++id) mapper.integrate(with_chair(id).make());
  const geometry::Pose turned(Eigen::AngleAxisd(2.5, Eigen::Vector3d::UnitY()));
  for (; id < 15; ++id) {
    mapper.integrate(SyntheticKeyframe(id).rectangle({60, 0, 200, 240}, 1.0).looked_for_objects().make());
    mapper.integrate(SyntheticKeyframe(id + 1000).looked_for_objects().pose(turned).make());
    mapper.integrate(SyntheticKeyframe(id + 2000).make());
  }
  EXPECT_EQ(mapper.map().objects().size(), 1U);
}

TEST(ObjectDatabase, WritesJson) {
  MapObject chair{
      .id = 3,
      .label = "ch\"air",
      .labels = {{"ch\"air", 0.8, 0.75}, {"sofa", 0.12345, 0.25}},
      .score = 0.75F,
      .center = {1, 2, 3},
      .size = {0.5, 0.25, 1},
      .upright = {{geometry::make_pose({1, 2, 3.5}, Eigen::Quaterniond(0.8, 0, 0, 0.6)), {0.5, 0.2, 1}},
                  1.2870022},
      .observations = 7,
      .first_seen_ns = 1'305'031'102'175'304'000,
      .last_seen_ns = 1'305'031'103'500'000'000,
      .seen_through = 3,
      .has_gone = true};
  const auto json = nlohmann::json::parse(to_json(std::vector{chair}));
  ASSERT_EQ(json.size(), 1U);
  EXPECT_EQ(json[0]["id"], 3);
  EXPECT_EQ(json[0]["label"], "ch\"air");
  EXPECT_EQ(json[0]["center"], (std::vector{1.0, 2.0, 3.0}));
  EXPECT_EQ(json[0]["size"], (std::vector{0.5, 0.25, 1.0}));
  EXPECT_EQ(json[0]["labels"],
            nlohmann::json::parse(
                R"([{"label": "ch\"air", "probability": 0.8}, {"label": "sofa", "probability": 0.1235}])"));
  EXPECT_EQ(json[0]["oriented"]["center"], (std::vector{1.0, 2.0, 3.5}));
  EXPECT_EQ(json[0]["oriented"]["size"], (std::vector{0.5, 0.2, 1.0}));
  EXPECT_EQ(json[0]["oriented"]["yaw"], 1.287);
  EXPECT_EQ(json[0]["oriented"]["orientation"], (std::vector{0.0, 0.0, 0.6, 0.8}));
  EXPECT_EQ(json[0]["observations"], 7);
  EXPECT_EQ(json[0]["movable"], false);
  EXPECT_NEAR(json[0]["first_seen"], 1305031102.175304, 1e-6);
  EXPECT_NEAR(json[0]["last_seen"], 1305031103.5, 1e-6);
  EXPECT_EQ(json[0]["gone"], true);
  EXPECT_EQ(to_json({}), "[]\n");
}

}  // namespace
}  // namespace rds::mapper
